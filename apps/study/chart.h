// Cases as jobs that run one by one, all or a shard of them, and the files that come of it.
// Invariant: but for times, the files of shards that are put together are those of a whole run.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "apps/study/chart_case.h"
#include "apps/study/chart_point.h"
#include "apps/study/shard.h"

namespace gnomon::apps::study {

inline constexpr std::string_view kChartName = "chart";

using ChartCases = std::vector<std::unique_ptr<ChartCase>>;

/// Runs the shard's jobs, each case gone when it is done, writes their pictures to OUT/pictures and
/// its part file to OUT. `progress` is told how many of its jobs are done. Throws ar::InputError.
ChartPart run_chart(ChartCases cases, const Shard& shard, int frames,
                    const std::filesystem::path& out,
                    const std::function<void(std::size_t)>& progress);

/// Writes OUT/chart.csv, chart.html and, where something was timed, chart.svg, of all jobs' points.
/// Throws ar::InputError.
void write_chart(const std::filesystem::path& out, const ChartPart& whole);

/// The parts that lie in OUT as a whole run's file, and write_chart of it. Throws ar::InputError.
ChartPart merge_chart(const std::filesystem::path& out);

}  // namespace gnomon::apps::study
