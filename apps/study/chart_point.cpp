#include "apps/study/chart_point.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/study/csv.h"
#include "apps/study/part_file.h"
#include "ar/error.h"
#include "ar/median.h"

namespace gnomon::apps::study {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr std::size_t kMostFrames = 1'000'000;

ordered_json to_json(const ChartPoint& point) {
  ordered_json out{{"job", point.job},       {"scene", point.scene},
                   {"family", point.family}, {"method", point.method},
                   {"oracle", point.oracle}, {"errors", ordered_json::array()}};
  for (const auto& [name, value] : point.errors) out["errors"].push_back({name, value});
  if (point.times.frames > 0)
    out["ms"] = {{"frames", point.times.frames},
                 {"median", point.times.median_ms},
                 {"low", point.times.low_ms},
                 {"high", point.times.high_ms}};
  if (!point.picture.empty()) out["picture"] = point.picture;
  if (!point.difference.empty()) out["difference"] = point.difference;
  return out;
}

double finite_number(const json& value) {
  const double number = value.get<double>();
  if (!std::isfinite(number) || number < 0.0)
    throw ar::InputError(fmt::format("{} is no error or time", value.dump()));
  return number;
}

std::string picture_name(const json& point, const char* key) {
  const std::string name = point.value(key, std::string());
  if (!name.empty() && !is_plain_name(name))
    throw ar::InputError(fmt::format("{}: '{}' is no plain file name", key, name.substr(0, 80)));
  return name;
}

ChartPoint point_of(const json& in) {
  ChartPoint point{.job = count_in(in.at("job"), kMostJobs),
                   .scene = in.at("scene").get<std::string>(),
                   .family = in.at("family").get<std::string>(),
                   .method = in.at("method").get<std::string>(),
                   .oracle = in.at("oracle").get<std::string>(),
                   .picture = picture_name(in, "picture"),
                   .difference = picture_name(in, "difference")};
  for (const json& error : in.at("errors"))
    point.errors.emplace_back(error.at(0).get<std::string>(), finite_number(error.at(1)));
  if (in.contains("ms")) {
    const json& ms = in.at("ms");
    point.times = {static_cast<int>(count_in(ms.at("frames"), kMostFrames)),
                   finite_number(ms.at("median")), finite_number(ms.at("low")),
                   finite_number(ms.at("high"))};
  }
  return point;
}

}  // namespace

Times times_of(std::vector<double> ms) {
  if (ms.empty()) return {};
  const auto [low, high] = std::ranges::minmax_element(ms);
  return {static_cast<int>(ms.size()), ar::median(ms), *low, *high};
}

void write_chart_part(const std::filesystem::path& file, const ChartPart& part) {
  ordered_json points = ordered_json::array();
  for (const ChartPoint& point : part.points) points.push_back(to_json(point));
  write_part(file, {{"format", kChartFormat},
                    {"shard", {part.shard.number, part.shard.count}},
                    {"jobs", part.jobs},
                    {"scenes", part.scenes},
                    {"frames", part.frames},
                    {"done", part.done},
                    {"points", points}});
}

ChartPart read_chart_part(const std::filesystem::path& file) {
  ChartPart part;
  read_part(file, kChartFormat, [&](const json& document) {
    part.shard = shard_in(document.at("shard"));
    part.jobs = count_in(document.at("jobs"), kMostJobs);
    part.scenes = document.at("scenes").get<std::vector<std::string>>();
    part.frames = static_cast<int>(count_in(document.at("frames"), kMostFrames));
    part.done = jobs_in(document.at("done"), part.jobs, part.shard);
    for (const json& point : document.at("points")) {
      part.points.push_back(point_of(point));
      if (std::ranges::find(part.done, part.points.back().job) == part.done.end())
        throw ar::InputError("a point belongs to no job of this part");
    }
  });
  return part;
}

ChartPart merge_chart_parts(std::span<const ChartPart> parts) {
  ChartPart whole;
  if (!parts.empty()) {
    whole.jobs = parts.front().jobs;
    whole.scenes = parts.front().scenes;
    whole.frames = parts.front().frames;
  }
  for (const ChartPart& part : parts) {
    if (part.jobs != whole.jobs || part.scenes != whole.scenes || part.frames != whole.frames)
      throw ar::InputError("parts of different runs do not belong together");
    whole.done.insert(whole.done.end(), part.done.begin(), part.done.end());
    whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  }
  std::ranges::sort(whole.done);
  require_every_job(whole.jobs, whole.done);
  std::ranges::stable_sort(whole.points, {}, &ChartPoint::job);
  return whole;
}

std::string chart_csv(const ChartPart& part) {
  std::string out =
      "scene,family,method,oracle,error,value,median_ms,low_ms,high_ms,frames,picture,difference\n";
  for (const ChartPoint& point : part.points) {
    const std::string times =
        point.times.frames > 0
            ? fmt::format("{},{},{},{}", point.times.median_ms, point.times.low_ms,
                          point.times.high_ms, point.times.frames)
            : std::string(",,,0");
    for (const auto& [name, value] : point.errors)
      out +=
          fmt::format("{},{},{},{},{},{},{},{},{}\n", csv_quoted(point.scene),
                      csv_quoted(point.family), csv_quoted(point.method), csv_quoted(point.oracle),
                      csv_quoted(name), value, times, point.picture, point.difference);
  }
  return out;
}

}  // namespace gnomon::apps::study
