#include "apps/page_template.h"

#include <algorithm>

#include "raster/check.h"

namespace gnomon::apps {

std::string fill_template(
    std::string_view page,
    const std::vector<std::pair<std::string_view, std::string_view>>& values) {
  std::string out;
  for (;;) {
    const std::size_t begin = page.find("{{");
    out += page.substr(0, begin);
    if (begin == std::string_view::npos) return out;
    const std::size_t end = page.find("}}", begin);
    raster::require(end != std::string_view::npos, "a template's marks are closed");
    const std::string_view name = page.substr(begin + 2, end - begin - 2);
    const auto value = std::ranges::find(values, name, [](const auto& v) { return v.first; });
    raster::require(value != values.end(), "a template names what is there");
    out += value->second;
    page.remove_prefix(end + 2);
  }
}

std::string script_safe(std::string json) {
  // "</script>" would end the element, and "<!--" begins a comment that holds one.
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos; ++at)
    json.replace(at, 1, "\\u003c");
  return json;
}

}  // namespace gnomon::apps
