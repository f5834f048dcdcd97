// Pages as one file: a template with marks, and what stands in their places.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon::apps {

/// The template with each {{name}} replaced. Precondition: it names no others.
std::string fill_template(std::string_view page,
                          const std::vector<std::pair<std::string_view, std::string_view>>& values);

/// JSON that may stand inside a <script> element.
std::string script_safe(std::string json);

}  // namespace gnomon::apps
