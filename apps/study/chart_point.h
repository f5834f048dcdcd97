// What one method with one setting did on one scene, and the file that keeps such points.
// Format "gnomon-chart 1" (docs/accuracy.md): JSON; a part holds the points of its jobs, and all
// parts together those of every job.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/study/shard.h"

namespace gnomon::apps::study {

inline constexpr const char* kChartFormat = "gnomon-chart 1";

/// Milliseconds a frame. No frames: nothing was timed.
struct Times {
  int frames = 0;
  double median_ms = 0.0, low_ms = 0.0, high_ms = 0.0;
  bool operator==(const Times&) const = default;
};

/// Median, least and most.
Times times_of(std::vector<double> ms);

struct ChartPoint {
  /// The number of its scene's job.
  std::size_t job = 0;
  std::string scene, family, method;
  /// What errors are measured against.
  std::string oracle;
  Times times;
  /// Name with unit, and value; the first is the scene's main one. Smaller is better.
  std::vector<std::pair<std::string, double>> errors;
  /// Names of files in the results' folder "pictures"; empty: none.
  std::string picture, difference;
  bool operator==(const ChartPoint&) const = default;
};

/// Points of a run, or of a part of one.
struct ChartPart {
  Shard shard;
  /// Of the whole run; `done` are those that are in this part, ascending.
  std::size_t jobs = 0;
  /// The scenes of all jobs, and frames that are timed: parts of one run agree on them.
  std::vector<std::string> scenes;
  int frames = 0;
  std::vector<std::size_t> done;
  /// In the order of their jobs.
  std::vector<ChartPoint> points;
  bool operator==(const ChartPart&) const = default;
};

/// Writes beside, then renames. Throws ar::InputError.
void write_chart_part(const std::filesystem::path& file, const ChartPart& part);

/// Throws ar::InputError in one line: another format, a missing or wrong value, numbers that are
/// not finite, names of pictures that are no plain file names.
ChartPart read_chart_part(const std::filesystem::path& file);

/// One part with every job once. Throws ar::InputError that names what is missing or twice, or when
/// parts are of other scenes or frames.
ChartPart merge_chart_parts(std::span<const ChartPart> parts);

/// As comma separated values with a heading.
std::string chart_csv(const ChartPart& part);

}  // namespace gnomon::apps::study
