#include "apps/study/chart.h"

#include "apps/output_folder.h"
#include "apps/study/chart_page.h"
#include "apps/study/chart_plot.h"
#include "apps/study/part_file.h"
#include "ar/file.h"
#include "ar/image_file.h"

#include <fmt/format.h>

namespace gnomon::apps::study {

namespace fs = std::filesystem;

namespace {

constexpr const char* kPictures = "pictures";

std::size_t all_jobs(const std::vector<std::unique_ptr<ChartCase>>& cases) {
  std::size_t jobs = 0;
  for (const auto& one : cases) jobs += one->settings();
  return jobs;
}

ChartPoint run_job(ChartCase& one, std::size_t setting, std::size_t job, int frames,
                   const fs::path& out) {
  Charted charted = one.run(setting, frames);
  ChartPoint& point = charted.point;
  point.job = job;
  const std::string name =
      fmt::format("{:04}_{}", job, plain_name(point.scene + "_" + point.method));
  point.picture = name + ".png";
  point.difference = name + "_difference.png";
  ar::write_png(out / kPictures / point.picture, charted.picture);
  ar::write_png(out / kPictures / point.difference, charted.difference);
  return std::move(point);
}

}  // namespace

std::size_t jobs_of(const std::vector<std::unique_ptr<ChartCase>>& cases, const Shard& shard) {
  const std::size_t jobs = all_jobs(cases);
  return jobs / shard.count + (jobs % shard.count >= shard.number ? 1 : 0);
}

ChartPart run_chart(const std::vector<std::unique_ptr<ChartCase>>& cases, const Shard& shard,
                    int frames, const fs::path& out,
                    const std::function<void(std::size_t)>& progress) {
  make_folder(out / kPictures);
  ChartPart part{shard, all_jobs(cases), {}};
  std::size_t job = 0;
  for (const auto& one : cases) {
    for (std::size_t setting = 0; setting < one->settings(); ++setting, ++job) {
      if (!shard.has(job)) continue;
      part.points.push_back(run_job(*one, setting, job, frames, out));
      progress(part.points.size());
    }
  }
  write_chart_part(part_file(out, kChartName, shard), part);
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
