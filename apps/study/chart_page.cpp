#include "apps/study/chart_page.h"

#include <map>

#include <nlohmann/json.hpp>

#include "apps/page_template.h"
#include "apps/study/page_assets.h"
#include "apps/study/page_image.h"

namespace gnomon::apps::study {

using nlohmann::ordered_json;

namespace {

ordered_json to_json(const ChartPoint& point, PageImages& images) {
  ordered_json out{{"family", point.family}, {"method", point.method}};
  ordered_json errors = ordered_json::array();
  for (const auto& error : point.errors) errors.push_back(error.second);
  out["errors"] = errors;
  if (point.times.frames > 0)
    out["ms"] = {{"frames", point.times.frames},
                 {"median", point.times.median_ms},
                 {"low", point.times.low_ms},
                 {"high", point.times.high_ms}};
  if (!point.picture.empty()) out["picture"] = images.add(point.picture);
  if (!point.difference.empty()) out["difference"] = images.add(point.difference);
  return out;
}

ordered_json scene_json(const ChartPoint& first) {
  ordered_json names = ordered_json::array();
  for (const auto& error : first.errors) names.push_back(error.first);
  return {{"name", first.scene},
          {"oracle", first.oracle},
          {"errors", names},
          {"points", ordered_json::array()}};
}

}  // namespace

std::string chart_page(const ChartPart& part, const std::filesystem::path& pictures) {
  PageImages images(pictures);
  ordered_json scenes = ordered_json::array();
  std::map<std::string, std::size_t> place;
  for (const ChartPoint& point : part.points) {
    const auto [at, fresh] = place.try_emplace(point.scene, scenes.size());
    if (fresh) scenes.push_back(scene_json(point));
    scenes[at->second]["points"].push_back(to_json(point, images));
  }
  const ordered_json data{{"scenes", scenes}, {"images", images.data_uris()}};
  const std::string json =
      script_safe(data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  return fill_template(
      kChartHtml,
      {{"css", kPageCss}, {"data", json}, {"library", kChartLibrary}, {"script", kChartScript}});
}

}  // namespace gnomon::apps::study
