// What Mesa's llvmpipe may make of a triangle: the outline that its clipper leaves and the depth
// that its plane has at a pixel, each with a bound of what float32 may have done to it.
//
// Source: Mesa 22.3, src/gallium/auxiliary/draw (viewport transform, draw_pipe_clip.c)
// and src/gallium/drivers/llvmpipe (lp_state_setup.c: plane through the vertices before the snap,
// as value at the window's origin and two slopes; lp_setup_tri.c: coverage after the snap to 1/256
// pixel). The model computes in double what Mesa computes in float32 and bounds the difference by
// first-order error analysis, u = 2^-24 a rounding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "raster/geometry.h"

namespace gnomon::peer {

/// A corner of the clipped triangle in window coordinates, y upwards, before the snap.
struct Corner {
  glm::dvec2 window_px{0.0};
  /// Window depth, 0 to 1 inside the depth range's widest.
  double depth = 0.0;
  /// Bounds of the error of each window coordinate and of the depth.
  double error_px = 0.0, error_depth = 0.0;
};

/// Convex; a fan round corner 0. Empty if nothing is left.
using Outline = std::vector<Corner>;

/// What llvmpipe's clipper leaves: it cuts at the view volume, without a guard band (with depth
/// clamp not in z).
Outline clipped_outline(const raster::DrawSetup& setup, const std::array<glm::vec4, 3>& clip,
                        int target_height);

/// Doubled signed area in the window.
double signed_area(const Outline& outline);

/// How far from an edge a pixel's centre may lie and be covered by one rasterizer and not by the
/// other: each of the edge's ends is snapped by up to half of 1/256 pixel along x and y, and
/// llvmpipe's may have been moved by float32 besides.
double edge_reach(const Corner& a, const Corner& b);

/// Distance of a point to the nearest edge that may decide its coverage, less that edge's reach:
/// not positive means that the two rasterizers may disagree.
double clearance_px(const Outline& outline, const glm::dvec2& point);
bool contains(const Outline& outline, const glm::dvec2& point);

/// Integers of the depth buffer.
struct DepthBounds {
  std::uint32_t low = 0, high = 0;
  /// How far the snap may bring gnomon's plane away from these, but for polygon offset. A point
  /// inside the snapped triangle is a mean of its corners, each half a step from the plane's own,
  /// so the planes are apart by no more than half a step's rise along x and y; one more for
  /// rounding.
  double slack = 0.0;
  /// The larger of the two slopes, in units a pixel, which polygon offset multiplies.
  double slope_low = 0.0, slope_high = 0.0;
};

/// How a depth becomes an integer: llvmpipe rounds it to the nearest, softpipe down.
enum class DepthRounding : std::uint8_t { nearest, down };

/// The depths that llvmpipe may give the pixel centre: those of the fan's pieces that may cover it.
DepthBounds depth_bounds(const raster::DrawSetup& setup, const Outline& outline,
                         const glm::dvec2& point, int target_height, DepthRounding rounding);

}  // namespace gnomon::peer
