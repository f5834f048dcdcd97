#include "apps/study/chart.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "apps/output_folder.h"
#include "apps/study/chart_page.h"
#include "apps/study/chart_plot.h"
#include "apps/study/part_file.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"

#include <fmt/format.h>

namespace gnomon::apps::study {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPictures = "pictures";

constexpr double kShort_ms = 50.0, kCap_ms = 2000.0;

void time_in_turns(const std::vector<std::unique_ptr<Contender>>& contenders, int frames,
                   std::vector<ChartPoint>& points) {
  std::vector<std::vector<double>> times(contenders.size());
  for (int frame = 0; frame < frames; ++frame) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      if (std::reduce(times[i].begin(), times[i].end()) > kCap_ms) continue;
      if (!times[i].empty() && times[i].back() < kShort_ms) contenders[i]->frame_ms();
      times[i].push_back(contenders[i]->frame_ms());
    }
  }
  for (std::size_t i = 0; i < times.size(); ++i) points[i].times = times_of(times[i]);
}

void run_job(ChartCase& one, std::size_t job, int frames, const fs::path& out, ChartPart& part) {
  const std::vector<std::unique_ptr<Contender>> contenders = one.contenders();
  std::vector<ChartPoint> points;
  for (const auto& contender : contenders) {
    Charted charted = contender->measure();
    ChartPoint& point = charted.point;
    point.job = job;
    const std::string name = fmt::format("{:02}_{:02}_{}", job, points.size(),
                                         plain_name(point.scene + "_" + point.method));
    point.picture = name + ".png";
    point.difference = name + "_difference.png";
    ar::write_png(out / kPictures / point.picture, charted.picture);
    ar::write_png(out / kPictures / point.difference, charted.difference);
    points.push_back(std::move(point));
  }
  time_in_turns(contenders, frames, points);
  std::ranges::move(points, std::back_inserter(part.points));
  part.done.push_back(job);
}

/// What a case's scene does that methods refuse is the scene file's mistake.
void run_named_job(ChartCase& one, std::size_t job, int frames, const fs::path& out,
                   ChartPart& part) {
  try {
    run_job(one, job, frames, out, part);
  } catch (const std::invalid_argument& misuse) {
    throw ar::InputError(ar::one_line(one.name()) + ": " + misuse.what());
  }
}

}  // namespace

ChartPart run_chart(ChartCases cases, const Shard& shard, int frames, const fs::path& out,
                    const std::function<void(std::size_t)>& progress) {
  make_folder(out / kPictures);
  const fs::path file = begin_part(out, kChartName, shard);
  ChartPart part{.shard = shard, .jobs = cases.size(), .frames = frames};
  for (const auto& one : cases) part.scenes.push_back(one->name());
  for (std::size_t job = 0; job < cases.size(); ++job) {
    if (!shard.has(job)) continue;
    run_named_job(*cases[job], job, frames, out, part);
    cases[job].reset();
    progress(part.done.size());
  }
  write_chart_part(file, part);
  return part;
}

void write_chart(const fs::path& out, const ChartPart& whole) {
  const std::string name(kChartName);
  ar::write_file(out / (name + ".csv"), chart_csv(whole));
  ar::write_file(out / (name + ".html"), chart_page(whole, out / kPictures));
  plot_chart(out / (name + ".svg"), whole);
}

ChartPart merge_chart(const fs::path& out) {
  std::vector<ChartPart> parts;
  for (const fs::path& file : find_parts(out, kChartName)) parts.push_back(read_chart_part(file));
  const ChartPart whole = merge_chart_parts(parts);
  write_chart_part(part_file(out, kChartName, whole.shard), whole);
  write_chart(out, whole);
  return whole;
}

}  // namespace gnomon::apps::study
