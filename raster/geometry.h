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

/// Weights of the vertices of a piece of a clipped triangle over the mesh's triangle.
using PieceWeights = std::array<glm::dvec3, 3>;

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

/// A triangle ready for the tiles, its vertices counter-clockwise.
struct SetupTriangle {
  static constexpr int kSmall = 31;
  static constexpr std::uint32_t kWhole = 0xffffffff;

  std::array<SnappedVertex, 3> vertices;
  /// Twice its area, positive.
  std::int64_t area = 1;
  DepthPlane depth;
  /// Its fragments' depths lie between these, in depth units.
  std::int32_t least_depth = 0, greatest_depth = 0;
  PixelBox box;
  /// The mesh's triangle is at this place among its indices.
  std::uint32_t first_index = 0;
  /// Where its weights stand among the pieces; kWhole if it is the mesh's triangle.
  std::uint32_t piece = kWhole;
  bool front_facing = true;
  /// Its vertices lie within kSmall x kSmall pixels.
  bool small = false;
  /// Vertices 1 and 2 are the mesh's 2 and 1.
  bool swapped = false;
  /// 1/w of the vertices.
  std::array<double, 3> inverse_w{};

  Edge edge(int k) const {
    const SnappedVertex& from = vertices[static_cast<std::size_t>((k + 1) % 3)];
    const SnappedVertex& to = vertices[static_cast<std::size_t>((k + 2) % 3)];
    return {from.y_fx - to.y_fx, to.x_fx - from.x_fx, from.x_fx, from.y_fx};
  }
};

/// Set-up triangles in the order of the mesh, with the weights of those that are pieces.
struct SetupTriangles {
  std::vector<SetupTriangle> triangles;
  std::vector<PieceWeights> pieces;

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
  /// Depth is clamped to [low, high] depth units.
  std::uint32_t depth_low = 0, depth_high = 0;
};

DrawSetup make_draw_setup(const Draw& draw, const Targets& targets);

/// A vertex inside the clip volume, projected and snapped; others are clipped first.
struct ProjectedVertex {
  SnappedVertex snapped;
  double inverse_w = 1.0;
};

/// Where a vertex in clip space is.
enum class VertexPlace : std::uint8_t { inside, outside, not_finite };

/// The vertices of a draw after the front end's first step, one a position.
struct DrawVertices {
  std::vector<glm::vec4> clip;
  std::vector<ProjectedVertex> projected;
  std::vector<VertexPlace> places;

  void resize(std::size_t count) {
    clip.resize(count);
    projected.resize(count);
    places.resize(count);
  }
};

/// Fills places and projected of vertices [first, last) from their clip-space positions.
void project_vertices(const DrawSetup& setup, DrawVertices& vertices, std::size_t first,
                      std::size_t last);

/// Appends the set-up triangles of mesh triangles [first, first + count), in order, without those
/// that cover no pixel.
void set_up_triangles(const DrawSetup& setup, const DrawVertices& vertices, std::size_t first,
                      std::size_t count, SetupTriangles& out);

}  // namespace gnomon::raster
