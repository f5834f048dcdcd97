// A monotonic stopwatch.
#pragma once

#include <chrono>

namespace gnomon::ar {

class Stopwatch {
 public:
  /// Milliseconds since it was made or last asked.
  double lap_ms() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace gnomon::ar
