// The ratios that this project set itself against its peers, computed from a run's rows.
#pragma once

#include <string>
#include <vector>

#include "bench/report.h"

namespace gnomon::bench {

struct Goal {
  std::string what;
  /// ">= 15" or "<= 0.60 ms".
  std::string asked;
  std::string measured;
  bool met = false;
};

/// Those whose rows the run has; `rows` are complete().
std::vector<Goal> goals(const std::vector<Row>& rows);

/// A line a goal.
std::string text(const std::vector<Goal>& goals);

}  // namespace gnomon::bench
