// Takes the jitter out of a tracked pose: the One Euro filter (Casiez, Roussel and Vogel 2012), a
// low-pass whose cut-off rises with speed, on translation (speed in m/s) and, separately, on
// rotation (a unit quaternion, speed in rad/s).
#pragma once

#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace gnomon::ar {

struct OneEuroOptions {
  /// Cut-off at rest: lower is calmer.
  double min_cutoff_hz = 1.0;
  /// Rise of the cut-off with speed: higher lags less.
  double beta_per_m = 200.0;
  double beta_per_rad = 40.0;
  /// Cut-off of the speed itself.
  double speed_cutoff_hz = 1.0;
  bool operator==(const OneEuroOptions&) const = default;
};

class PoseFilter {
 public:
  /// Misuse: a cut-off that is not positive, a negative beta.
  explicit PoseFilter(const OneEuroOptions& options);

  /// The filtered pose. The first one, and one whose time is not after the last, passes unchanged
  /// and starts the filter anew.
  glm::dmat4 filter(const glm::dmat4& pose, double time_s);

  void reset() { last_.reset(); }

 private:
  struct Memory {
    double time_s = 0.0;
    glm::dvec3 position{0.0}, velocity{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    /// Rotation vector per second.
    glm::dvec3 turning{0.0};
    /// What came in last, from which speeds are taken.
    glm::dvec3 raw_position{0.0};
    glm::dquat raw_rotation{1.0, 0.0, 0.0, 0.0};
  };

  OneEuroOptions options_;
  std::optional<Memory> last_;
};

}  // namespace gnomon::ar
