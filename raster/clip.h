// Homogeneous clipping (OpenGL 4.6 compatibility, section 13.7) of a triangle against w > 0, the
// near and far planes, and a guard band in x and y; what lies outside the viewport but inside the
// guard band is left to the rasterizer. Invariant: a crossed edge is cut from its inner to its
// outer end, so two triangles that share it get the same vertex. Arithmetic is double: differences
// of float32 coordinates are then exact or nearly so, and a sliver keeps its edge.
#pragma once

#include <array>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace gnomon::raster {

/// Smallest w of a clipped vertex, rounding included: what is nearer to the eye plane is cut off,
/// with depth clamp too.
inline constexpr double kMinW = 1.0 / (1 << 24);

struct ClipVertex {
  glm::dvec4 position;
  /// Position = sum of weights times the triangle's own three positions.
  glm::dvec3 weights;
};

/// A convex polygon of up to three vertices and one more a plane.
struct ClippedPolygon {
  std::array<ClipVertex, 10> vertices;
  int count = 0;
};

struct ClipVolume {
  /// |x| <= guard_x * w and |y| <= guard_y * w.
  double guard_x, guard_y;
  bool near_and_far;

  /// No plane cuts this vertex off.
  bool contains(const glm::vec4& position) const;
};

/// The part of the triangle inside the volume, wound as the triangle; empty if nothing is left.
/// Precondition: finite positions.
ClippedPolygon clip_triangle(const std::array<glm::vec4, 3>& triangle, const ClipVolume& volume);

}  // namespace gnomon::raster
