// How time and memory grow with triangles and with pixels.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/measure.h"
#include "bench/runner.h"
#include "bench/turns.h"

namespace gnomon::bench {

struct GrowthOptions {
  /// Of one round at one x.
  TurnOptions turns{.frames = 3, .cap_s = 10.0};
  /// All of x is gone through so often: a busy minute does not bend the curves at one place.
  int rounds = 3;
  int threads = 2;
  /// Larger steps are left out.
  double most_triangles = 1e7, most_pixels = 7680.0 * 4320.0;
};

/// One system and method at growing x.
struct Curve {
  System system = System::gnomon;
  Method method = Method::automatic;
  struct Point {
    /// Triangles, or pixels.
    double x = 0.0;
    StageTimes ms;
    /// Most memory that the process held beyond the loaded scene.
    double memory_mib = 0.0;
  };
  std::vector<Point> points;

  /// The exponent of the stage's time over the last `last` points; absent with fewer than two.
  std::optional<double> slope(Stage stage, std::size_t last) const;
};

struct Growth {
  /// Twelve tori at 640x480, tessellated ever finer; and as they are, at ever larger sizes.
  std::vector<Curve> by_triangles, by_pixels;
};

/// Checks pictures and times; progress goes to standard error. Throws std::runtime_error as
/// measure() does.
Growth measure_growth(const GrowthOptions& options);

nlohmann::json to_json(const Growth& growth, const Report& now);

/// A line a point, and the slopes, for a terminal.
std::string table(const Growth& growth);

}  // namespace gnomon::bench
