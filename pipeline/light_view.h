// What a light sees, laid out flat: the plane that its shadow map shows.
#pragma once

#include <array>
#include <limits>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/basis.h"
#include "pipeline/half_space.h"
#include "pipeline/scene.h"

namespace gnomon::pipeline {

/// Of places of a light's view; empty until something is added.
struct Rectangle {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec2& p);
  bool empty() const { return !(low.x < high.x && low.y < high.y); }
  glm::dvec2 extent() const { return high - low; }
};

/// Places are slopes against the axis (a point light) or metres across it (a direction); distances
/// are metres along the axis.
class LightView {
 public:
  /// About the axis from a point light to `aim`, or along a light's direction with `aim` at the
  /// origin. Precondition: `aim` is not where a point light is.
  static LightView towards(const Light& light, const glm::dvec3& aim);
  /// Of a point light, about an axis of unit length.
  static LightView about(const Light& light, const glm::dvec3& axis);

  bool is_point() const { return is_point_; }
  glm::dvec3 local(const glm::dvec3& p) const { return basis_(p - origin_); }
  glm::dvec2 place(const glm::dvec3& local) const {
    return is_point_ ? glm::dvec2(local) / local.z : glm::dvec2(local);
  }
  /// Metres that one unit of place is at a point.
  double metres(const glm::dvec3& local) const { return is_point_ ? local.z : 1.0; }

  /// The points whose place is in the rectangle; of a point light only those before it.
  std::array<HalfSpace, 4> sides(const Rectangle& r) const;

  /// The directions (world space) from a point light to the rectangle's corners, in turn.
  std::array<glm::dvec3, 4> corners(const Rectangle& r) const;

  /// OpenGL's clip space of the rectangle between two distances.
  glm::mat4 clip_from_world(const Rectangle& r, double near, double far) const;

  /// The greatest change of depth (of [0, 1]) a metre.
  double depth_rate(double near, double far) const;

 private:
  LightView(bool is_point, const glm::dvec3& origin, const glm::dvec3& axis)
      : is_point_(is_point), basis_(basis_about(axis)), origin_(origin) {}
  /// The points whose place is not below `bound` along a coordinate (not above it, for sign -1).
  HalfSpace beside(const glm::dvec3& along, double bound, double sign) const;

  bool is_point_;
  Basis basis_;
  glm::dvec3 origin_;
};

}  // namespace gnomon::pipeline
