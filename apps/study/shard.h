// A part of many independent jobs, so that several processes or machines share them: shard i of n
// has every n-th job (Slurm's job arrays and MPI launchers count so).
#pragma once

#include <cstddef>
#include <string>

namespace gnomon::apps::study {

inline constexpr std::size_t kMostShards = 100'000;

struct Shard {
  /// From 1 to count.
  std::size_t number = 1, count = 1;

  bool has(std::size_t job) const { return job % count == number - 1; }
  /// How many of so many jobs it has.
  std::size_t share_of(std::size_t jobs) const {
    return jobs / count + (jobs % count >= number ? 1 : 0);
  }
  bool is_whole() const { return count == 1; }
  bool operator==(const Shard&) const = default;
};

/// Reads "i/n" with 1 <= i <= n <= kMostShards. Throws ar::InputError that names `option`.
Shard parse_shard(const std::string& option, const std::string& text);

}  // namespace gnomon::apps::study
