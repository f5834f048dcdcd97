// What sweeps found, and the file that keeps it. Format "gnomon-stability 1" (docs/accuracy.md):
// JSON; a job is one value of one sweep.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/study/shard.h"
#include "apps/study/sweep.h"

namespace gnomon::apps::study {

inline constexpr const char* kStabilityFormat = "gnomon-stability 1";

/// A share from which a method counts as given up.
inline constexpr double kGivenUp = 0.01;

/// One value of one sweep.
struct StabilityColumn {
  std::size_t job = 0;
  std::size_t sweep = 0;
  std::string value;
  std::size_t inputs = 0;
  /// One a method: the sum over the inputs, and the largest share of an input.
  std::vector<Outcome> outcomes;
  std::vector<double> worst;
  bool operator==(const StabilityColumn&) const = default;
};

struct StabilityPart {
  Shard shard;
  std::size_t jobs = 0;
  std::vector<SweepText> sweeps;
  /// One list a sweep.
  std::vector<std::vector<std::string>> methods;
  /// Ascending by job.
  std::vector<StabilityColumn> columns;
  bool operator==(const StabilityPart&) const = default;
};

/// Writes beside, then renames. Throws ar::InputError.
void write_stability_part(const std::filesystem::path& file, const StabilityPart& part);
/// Throws ar::InputError in one line.
StabilityPart read_stability_part(const std::filesystem::path& file);
/// Throws ar::InputError that names what is missing or twice, or when parts are of different runs.
StabilityPart merge_stability_parts(std::span<const StabilityPart> parts);

/// As comma separated values with a heading.
std::string stability_csv(const StabilityPart& part);

/// Of a sweep's columns, the first from which on the method's share is kGivenUp or more at every
/// one; their number where it never gives up.
std::size_t border_of(const std::vector<const StabilityColumn*>& columns, std::size_t method);

/// Columns of one sweep, in order.
std::vector<const StabilityColumn*> columns_of(const StabilityPart& part, std::size_t sweep);

}  // namespace gnomon::apps::study
