// How many passes fit in a frame's time (Gibson 2003, section 8: accuracy against frame rate).
#pragma once

#include <cstddef>

namespace gnomon::pipeline {

/// Takes a frame's time as a + b * passes, both found from the frames so far, old ones counting
/// less and less, and gives the passes that fill the budget.
class PassBudget {
 public:
  /// Misuse: a budget that is not positive, `most` of 0.
  PassBudget(double budget_ms, std::size_t most);

  /// For the next frame; from 1 to `most`.
  std::size_t passes() const { return passes_; }

  /// What a frame of so many passes took. Times that are not finite or negative are passed over.
  void add(std::size_t passes, double frame_ms);

 private:
  double budget_ms_;
  std::size_t most_, passes_;
  /// Weighted sums: 1, n, n^2, t, n t.
  double one_ = 0.0, n_ = 0.0, nn_ = 0.0, t_ = 0.0, nt_ = 0.0;
};

}  // namespace gnomon::pipeline
