// Sweeps as jobs, one a value, that run one by one, all or a shard of them, and the files that come
// of it. Invariant: the files of shards that are put together are those of a whole run.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "apps/study/shard.h"
#include "apps/study/stability_part.h"
#include "apps/study/sweep.h"

namespace gnomon::apps::study {

inline constexpr std::string_view kStabilityName = "stability";

using Sweeps = std::vector<std::unique_ptr<Sweep>>;

/// One a value of each sweep.
std::size_t jobs_of(const Sweeps& sweeps);

/// Runs the shard's jobs and writes its part file to OUT. `progress` is told how many are done.
/// Throws ar::InputError.
StabilityPart run_stability(const Sweeps& sweeps, const Shard& shard,
                            const std::filesystem::path& out,
                            const std::function<void(std::size_t)>& progress);

/// Writes OUT/stability.csv and stability.html. Throws ar::InputError.
void write_stability(const std::filesystem::path& out, const StabilityPart& whole);

/// The parts that lie in OUT as a whole run's file, and write_stability of it. Throws
/// ar::InputError.
StabilityPart merge_stability(const std::filesystem::path& out);

/// Inputs that methods were tried on: each of a sweep's inputs at each of its values.
std::size_t inputs_of(const StabilityPart& part);

}  // namespace gnomon::apps::study
