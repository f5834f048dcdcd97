// Frames timed in turns: one of each worker, again and again, so that a machine that slows down
// slows all of them alike.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bench/worker.h"

namespace gnomon::bench {

struct TurnOptions {
  int frames = 20;
  /// A worker that has taken so long is left out, after no less than three frames.
  double cap_s = 20.0;
};

/// What one worker took.
struct Series {
  /// Milliseconds of each frame, by Stage.
  std::array<std::vector<double>, kStages.size()> times;
  int frames = 0;

  void append(const Series& other);
  /// Medians; absent where there is no such stage.
  StageTimes medians() const;
};

/// One series a worker. A frame under 50 ms is drawn once more just before it is timed: every
/// system finds its own data in the caches although others had their turn.
std::vector<Series> take_turns(const std::vector<std::unique_ptr<Worker>>& workers,
                               const TurnOptions& options);

}  // namespace gnomon::bench
