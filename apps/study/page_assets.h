// The text files that pages are put together from, as they were when the program was built.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gnomon::apps::study {

extern const std::string_view kPageCss, kChartHtml, kChartScript, kStabilityHtml, kStabilityScript;
/// Chart.js (chartjs.org, MIT licence), minified.
extern const std::string_view kChartLibrary;

/// The template with each {{name}} replaced. Precondition: it names no others.
std::string fill_template(std::string_view page,
                          const std::vector<std::pair<std::string_view, std::string_view>>& values);

/// JSON that may stand inside a <script> element.
std::string script_safe(std::string json);

}  // namespace gnomon::apps::study
