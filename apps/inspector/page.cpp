#include "apps/inspector/page.h"

#include <string_view>

#include <nlohmann/json.hpp>

#include "apps/page_template.h"
#include "ar/base64.h"
#include "ar/error.h"
#include "ar/false_color.h"

namespace gnomon::apps::inspector {

using nlohmann::ordered_json;

extern const std::string_view kEngine, kCss, kPageHtml, kInspectHtml, kLabHtml, kEngineScript,
    kViewScript, kHistoryScript, kInspectScript, kLabScript;

namespace {

/// `name`: of the page; `title`: of what it shows.
std::string fill(const char* name, std::string_view body, std::string_view script,
                 const ordered_json& frames, const std::string& title) {
  if (kEngine.empty())
    throw ar::InputError(
        "this gnomon was built without clang++-16 for WebAssembly, so it has no pages "
        "(packages.txt; then build anew)");
  ordered_json palette = ordered_json::array();
  for (int value = 0; value < 256; ++value)
    palette.push_back(ar::stencil_color(static_cast<std::uint8_t>(value)));
  const ordered_json data{{"format", "gnomon-inspection"},
                          {"version", 1},
                          {"title", title},
                          {"palette", palette},
                          {"frames", frames}};
  const std::string json =
      script_safe(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  return fill_template(kPageHtml, {{"css", kCss},
                                   {"title", name},
                                   {"body", body},
                                   {"data", json},
                                   {"engine", kEngine},
                                   {"engine_script", kEngineScript},
                                   {"view_script", kViewScript},
                                   {"history_script", kHistoryScript},
                                   {"script", script}});
}

}  // namespace

std::string inspect_page(const std::string& title, const std::vector<PageFrame>& frames) {
  ordered_json list = ordered_json::array();
  for (const PageFrame& frame : frames)
    list.push_back({{"name", frame.name}, {"bytes", ar::base64_from_bytes(frame.bytes)}});
  return fill("gnomon inspect", kInspectHtml, kInspectScript, list, title);
}

std::string lab_page() {
  return fill("gnomon lab", kLabHtml, kLabScript, ordered_json::array(), "gnomon lab");
}

}  // namespace gnomon::apps::inspector
