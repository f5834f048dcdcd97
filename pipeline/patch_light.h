// Light from patch to point (Gibson 2003, section 5): form factors in closed form, and visibility
// by rays through the patches themselves.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "pipeline/patches.h"

namespace gnomon::pipeline {

/// The share of what a surface element at `point` would receive from a full hemisphere of equal
/// radiance, that comes from the triangle: irradiance = pi * radiance * form_factor. The part below
/// the element's horizon is cut off; 0 where the element is behind the triangle. Lambert's contour
/// integral (Baum, Rushmeier and Winget 1989). Precondition: `normal` has unit length.
double form_factor(const glm::dvec3& point, const glm::dvec3& normal,
                   const std::array<glm::dvec3, 3>& triangle);

/// A surface's point, so far off it that a ray from there does not meet it.
glm::dvec3 lifted(const glm::dvec3& point, const glm::dvec3& normal);

/// Centroids of a triangle cut in 1, 4 or 16, as weights of its corners. Misuse: another number.
std::span<const glm::dvec3> patch_samples(int samples);

/// Asks what stands between patches and points. Safe for use by several threads at once.
class PatchVisibility {
 public:
  /// Errors: std::runtime_error when Embree cannot start.
  explicit PatchVisibility(const PatchModel& model);
  ~PatchVisibility();
  PatchVisibility(const PatchVisibility&) = delete;
  PatchVisibility& operator=(const PatchVisibility&) = delete;

  /// The share of `samples` (1, 4 or 16: centroids of the triangle cut in so many) points of the
  /// patch that nothing hides from `point`, which lies on a surface with this normal; of those
  /// above its horizon, 0 if none is.
  double visible_share(const Patch& patch, const glm::dvec3& point, const glm::dvec3& normal,
                       int samples) const;
  /// The same with a question of one's own: counts(from, to), the two ends lifted off their
  /// surfaces.
  template <class Counts>
  double share_of_samples(const Patch& patch, const glm::dvec3& point, const glm::dvec3& normal,
                          int samples, const Counts& counts) const {
    const auto [a, b, c] = model().corners(patch);
    const glm::dvec3 from = lifted(point, normal);
    int counted = 0, asked = 0;
    for (const glm::dvec3& weights : patch_samples(samples)) {
      const glm::dvec3 to = lifted(a * weights.x + b * weights.y + c * weights.z, patch.normal);
      if (glm::dot(to - from, normal) <= 0.0) continue;
      ++asked;
      counted += counts(from, to) ? 1 : 0;
    }
    return asked == 0 ? 0.0 : static_cast<double>(counted) / asked;
  }
  /// No patch lies between two points.
  bool sees(const glm::dvec3& from, const glm::dvec3& to) const;
  /// The same where `to` is on this patch: a distant one is seen through clear surfaces.
  bool sees(const Patch& patch, const glm::dvec3& from, const glm::dvec3& to) const;
  /// The nearest patch of the scene itself along a ray, seen from either side; kNone where there is
  /// none.
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Hit {
    std::size_t patch = kNone;
    /// In units of the direction's length.
    double distance = 0.0;
    /// Where in the patch, as weights of its three vertices.
    glm::dvec3 weights{0.0};
    /// Seen from the side that gives light.
    bool front = false;
  };
  Hit trace(const glm::dvec3& origin, const glm::dvec3& direction) const;

 private:
  const PatchModel& model() const;

  struct World;
  std::unique_ptr<World> world_;
};

/// Light that arrives at a point of a surface, from all patches with radiance: pi * sum of radiance
/// * form factor * visible share. `radiance` is one a patch. Deterministic: summed in order.
glm::dvec3 irradiance(const PatchModel& model, const std::vector<glm::vec3>& radiance,
                      const PatchVisibility& visibility, const glm::dvec3& point,
                      const glm::dvec3& normal, int samples);

}  // namespace gnomon::pipeline
