// A run: every subject and size, all systems in turn.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/report.h"
#include "bench/turns.h"

namespace gnomon::bench {

struct Options {
  /// Names, or their beginnings up to a dash; empty: all usual ones.
  std::vector<std::string> scenes;
  /// Empty: each subject's usual ones.
  std::vector<Size> sizes;
  std::vector<int> threads{1, 2};
  std::vector<System> systems{kSystems.begin(), kSystems.end()};
  TurnOptions turns;
  std::vector<std::filesystem::path> models;
};

/// Checks and times. Progress goes to standard error. Throws std::runtime_error for a wrong picture
/// or a system that fails, std::invalid_argument for an unknown scene.
Report measure(const Options& options);

/// Empty report with date, processor, commit and load of here and now.
Report report_of_now();

}  // namespace gnomon::bench
