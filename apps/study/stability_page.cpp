#include "apps/study/stability_page.h"

#include <nlohmann/json.hpp>

#include "apps/page_template.h"
#include "apps/study/page_assets.h"

namespace gnomon::apps::study {

using nlohmann::ordered_json;

namespace {

ordered_json sweep_json(const StabilityPart& part, std::size_t number) {
  const SweepText& text = part.sweeps[number];
  const auto columns = columns_of(part, number);
  ordered_json values = ordered_json::array(), methods = ordered_json::array();
  std::size_t inputs = 0;
  for (const StabilityColumn* column : columns) {
    values.push_back(column->value);
    inputs += column->inputs;
  }
  for (std::size_t i = 0; i < part.methods[number].size(); ++i) {
    ordered_json cells = ordered_json::array();
    for (const StabilityColumn* column : columns) {
      const Outcome& o = column->outcomes[i];
      cells.push_back({{"share", o.share()},
                       {"wrong", o.wrong},
                       {"of", o.of},
                       {"worst", column->worst[i]},
                       {"inputs", column->inputs},
                       {"notFinite", o.not_finite}});
    }
    methods.push_back(
        {{"name", part.methods[number][i]}, {"border", border_of(columns, i)}, {"cells", cells}});
  }
  return {{"name", text.name},
          {"title", text.title},
          {"explanation", text.explanation},
          {"parameter", text.parameter},
          {"measure", text.measure},
          {"oracle", text.oracle},
          {"inputs", inputs},
          {"values", values},
          {"methods", methods}};
}

}  // namespace

std::string stability_page(const StabilityPart& part) {
  ordered_json sweeps = ordered_json::array();
  for (std::size_t i = 0; i < part.sweeps.size(); ++i) sweeps.push_back(sweep_json(part, i));
  const ordered_json data{{"givenUp", kGivenUp}, {"sweeps", sweeps}};
  const std::string json =
      script_safe(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  return fill_template(kStabilityHtml,
                       {{"css", kPageCss}, {"data", json}, {"script", kStabilityScript}});
}

}  // namespace gnomon::apps::study
