// The front end: vertices to clip space, clipping, projection, the snap to 1/256 pixel, and
// triangle set-up in integers. Floats end here. Order of operations (docs/semantics.md): clip =
// ((m0 x + m1 y) + m2 z) + m3 w in float32, each rounded once; division by w and viewport in
// double; coordinates and depth rounded to nearest, ties to even.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "raster/depth_plane.h"
#include "raster/frame.h"

namespace gnomon::raster {

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

PixelBox intersect(const PixelBox& a, const PixelBox& b);
/// The scissor's pixels inside a target of this size.
PixelBox scissor_box(const std::optional<Rect>& scissor, int width, int height);

/// What the fragments of a triangle need to interpolate: the mesh's triangle, 1/w of the snapped
/// vertices, and (for a piece of a clipped triangle) their weights over the mesh's triangle.
struct Attributes {
  std::uint32_t first_index = 0;
  std::array<double, 3> inverse_w{};
  std::array<glm::dvec3, 3> weights{};
};

/// A triangle ready for the tiles. Edge k is opposite to vertex k:
///   E_k(x, y) = a x + b y + c over 24.8 coordinates, positive inside; E_0 + E_1 + E_2 = area.
/// A pixel is covered where E_k - bias_k >= 0 for each k at its centre; bias is 0 on top and left
/// edges, 1 on others.
struct SetupTriangle {
  std::array<std::int32_t, 3> a{}, b{};
  std::array<std::int64_t, 3> c{};
  std::array<std::uint8_t, 3> bias{};
  bool front_facing = true;
  PixelBox box;
  DepthPlane depth;
  Attributes attributes;

  std::int64_t edge(int k, std::int64_t x_fx, std::int64_t y_fx) const {
    const auto i = static_cast<std::size_t>(k);
    return a[i] * x_fx + b[i] * y_fx + c[i];
  }
};

/// What all triangles of a draw share.
struct DrawSetup {
  const Draw* draw = nullptr;
  DepthFormat depth_format = DepthFormat::d24;
  PixelBox box;
  Rect viewport;
  /// Depth is clamped to [low, high] depth units.
  std::uint32_t depth_low = 0, depth_high = 0;
};

DrawSetup make_draw_setup(const Draw& draw, const Targets& targets);

/// Appends the set-up triangles of mesh triangles [first, first + count), in order, without those
/// that cover no pixel. `clip` holds the clip-space positions of all vertices of the draw.
void set_up_triangles(const DrawSetup& setup, std::span<const glm::vec4> clip, std::size_t first,
                      std::size_t count, std::vector<SetupTriangle>& out);

}  // namespace gnomon::raster
