// The front end: vertices to clip space and to the window (raster/project.h), the triangles that
// reach the tiles (raster/select_triangles.h), clipping, and triangle set-up in integers. Order of
// operations of the transform (docs/semantics.md): clip = ((m0 x + m1 y) + m2 z) + m3 w in float32,
// each rounded once.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "raster/depth_plane.h"
#include "raster/frame.h"
#include "raster/kernels.h"
#include "raster/pixel_box.h"
#include "raster/project.h"

namespace gnomon::raster {

PixelBox intersect(const PixelBox& a, const PixelBox& b);
/// The scissor's pixels inside a target of this size.
PixelBox scissor_box(const std::optional<Rect>& scissor, int width, int height);

/// What is interpolated over a piece of a clipped triangle: 1/w of its vertices and their weights
/// over the mesh's triangle.
struct Piece {
  std::array<double, 3> inverse_w;
  std::array<glm::dvec3, 3> weights;
};

/// Twice the signed area, positive if counter-clockwise.
inline std::int64_t doubled_area(const SnappedVertex& a, const SnappedVertex& b,
                                 const SnappedVertex& c) {
  return std::int64_t{b.x_fx - a.x_fx} * (c.y_fx - a.y_fx) -
         std::int64_t{c.x_fx - a.x_fx} * (b.y_fx - a.y_fx);
}

/// Edge k of a triangle, opposite to vertex k: E(x, y) = a (x - x0) + b (y - y0) over 24.8
/// coordinates, positive inside; the three sum to the area. A pixel is covered where E - bias >= 0
/// for each at its centre; bias is 0 on left and bottom edges, 1 on others.
struct Edge {
  std::int32_t a, b, x0, y0;

  std::int64_t at(std::int64_t x_fx, std::int64_t y_fx) const {
    return a * (x_fx - x0) + b * (y_fx - y0);
  }
  // Counter-clockwise with y upwards: a left edge goes down, a bottom edge goes right.
  int bias() const { return a > 0 || (a == 0 && b > 0) ? 0 : 1; }
};

/// A triangle ready for the tiles, its vertices counter-clockwise. Small, because threads hand them
/// to each other.
struct SetupTriangle {
  static constexpr std::uint32_t kWhole = 0xffffffff;

  /// Polygon offset is part of their depths.
  std::array<SnappedVertex, 3> vertices;
  /// Slopes of depth a pixel (raster/depth_plane.h).
  std::uint64_t step_x = 0, step_y = 0;
  /// The plane's base at the tile of pixel (x0, y0), if has_base.
  std::uint64_t base = 0;
  /// The mesh's triangle is at this place among its indices.
  std::uint32_t first_index = 0;
  /// Its place among the pieces; kWhole if it is the mesh's triangle.
  std::uint32_t piece = kWhole;
  std::int16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// Those it covers, if its box is tiny and they are known; otherwise 0.
  TinyPixels pixels = 0;
  bool front_facing = true;
  /// Its vertices lie within kSmallPixels of each other in x and y.
  bool small = false;
  /// Vertices 1 and 2 are the mesh's 2 and 1.
  bool swapped = false;
  /// DepthPlane::narrow.
  bool narrow = true;
  bool has_base = false;

  /// The pixels it may cover.
  PixelBox box() const { return {x0, y0, x1, y1}; }
  /// Twice its area, positive.
  std::int64_t area() const { return doubled_area(vertices[0], vertices[1], vertices[2]); }

  Edge edge(int k) const {
    const SnappedVertex& from = vertices[static_cast<std::size_t>((k + 1) % 3)];
    const SnappedVertex& to = vertices[static_cast<std::size_t>((k + 2) % 3)];
    return {from.y_fx - to.y_fx, to.x_fx - from.x_fx, from.x_fx, from.y_fx};
  }
  /// The pixel's centre lies inside box and edges.
  bool covers(int x, int y) const;
  /// The depth that a fragment at the pixel gets.
  std::uint32_t depth_at(int x, int y, const struct DrawSetup& setup) const;
};

/// Set-up triangles in the order of the mesh, and what is interpolated over those that are pieces.
struct SetupTriangles {
  std::vector<SetupTriangle> triangles;
  std::vector<Piece> pieces;

  void clear() {
    triangles.clear();
    pieces.clear();
  }
};

/// What all triangles of a draw share.
struct DrawSetup {
  const Draw* draw = nullptr;
  DepthFormat depth_format = DepthFormat::d24;
  PixelBox box;
  Rect viewport;
  Projection projection;
  /// Depth is clamped to [low, high] depth units.
  std::uint32_t depth_low = 0, depth_high = 0;
};

DrawSetup make_draw_setup(const Draw& draw, const Targets& targets);

/// The vertices of a draw after the front end's first step, one a position.
struct DrawVertices {
  std::vector<glm::vec4> clip;
  /// Projected (raster/project.h), where x is not kClipped.
  std::vector<std::int32_t> x_fx, y_fx;
  std::vector<std::int64_t> z_fx;
  std::vector<double> inverse_w;

  void resize(std::size_t count) {
    clip.resize(count);
    x_fx.resize(count);
    y_fx.resize(count);
    z_fx.resize(count);
    inverse_w.resize(count);
  }
};

/// Colours of a draw's vertices on front and on back faces: the mesh's, or what lighting at
/// vertices gave. Empty: 1.
struct VertexColors {
  std::span<const glm::vec4> front, back;

  std::span<const glm::vec4> of(bool front_facing) const { return front_facing ? front : back; }
};

/// Where the attributes of a chunk's triangles come from.
struct TriangleSource {
  /// 1/w of the draw's vertices.
  std::span<const double> inverse_w_of_vertex;
  std::span<const Piece> pieces;
  VertexColors colors;

  /// 1/w of the triangle's vertices.
  std::array<double, 3> inverse_w(const SetupTriangle& triangle,
                                  std::span<const std::uint32_t> indices) const;
};

/// The bounds of a triangle's depths by those of its vertices, in depth units.
struct DepthInterval {
  std::int32_t least, greatest;
};
inline DepthInterval vertex_depths(const SetupTriangle& triangle, const DrawSetup& setup) {
  const auto& v = triangle.vertices;
  const auto [least, greatest] = std::minmax({v[0].z_fx, v[1].z_fx, v[2].z_fx});
  const int bits = depth_fraction_bits(setup.depth_format);
  const std::int64_t half = std::int64_t{1} << (bits - 1);
  const auto units = [&](std::int64_t value) {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>((value + half) >> bits, setup.depth_low, setup.depth_high));
  };
  return {units(least - kPlaneError), units(greatest + kPlaneError)};
}

/// Projects vertices [first, last) from their clip-space positions.
void project_vertices(const Kernels& kernels, const DrawSetup& setup, DrawVertices& vertices,
                      std::size_t first, std::size_t last);

/// Appends the set-up triangles of mesh triangles [first, first + count), in order, without those
/// that cover no pixel.
void set_up_triangles(const Kernels& kernels, const DrawSetup& setup, const DrawVertices& vertices,
                      std::size_t first, std::size_t count, SetupTriangles& out);

}  // namespace gnomon::raster
