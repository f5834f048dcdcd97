// One draw fragment by fragment, the slow and obvious way, for those who ask what happened: pixel
// histories (raster/history.h) and fates (raster/draw_fates.h).
// Invariant: a pixel's fragments, each applied in turn to what is stored there, leave the bytes
// that execute() leaves.
#pragma once

#include <cstdint>
#include <functional>

#include "raster/draw_geometry.h"
#include "raster/fragment_fate.h"
#include "raster/frame.h"
#include "raster/lit_vertices.h"

namespace gnomon::raster {

/// A fragment before its tests.
struct TracedFragment {
  const SetupTriangle* triangle;
  const TriangleSource* source;
  int x, y;
  std::uint32_t depth;

  /// Of the mesh.
  std::uint32_t triangle_number() const { return triangle->first_index / 3; }
};

class DrawTrace {
 public:
  /// Brings the draw's triangles to the window. Both outlive it.
  DrawTrace(const Draw& draw, const Targets& targets);

  /// The fragments in the box, triangle after triangle in the mesh's order.
  void for_each_fragment(const PixelBox& box,
                         const std::function<void(const TracedFragment&)>& visit) const;

  /// The triangles that are drawn, clipped and culled, in order.
  void for_each_triangle(const std::function<void(const SetupTriangle&)>& visit) const;

  /// What the pixel's values become. Depth buffers that the draw looks up hold what they held when
  /// it was drawn.
  Outcome apply(const TracedFragment& fragment, PixelValues& pixel) const;
  /// The same without colour.
  Outcome test(const TracedFragment& fragment, PixelValues& pixel) const;

  /// The stencil operation that a fragment with this outcome is given; keep without a stencil test.
  StencilOp stencil_op(bool front_facing, Outcome outcome) const;

 private:
  const StencilFace* face(bool front_facing) const;

  const Draw& draw_;
  const Targets& targets_;
  const DrawSetup setup_;
  DrawGeometry geometry_;
  LitVertices lit_;
  VertexColors colors_;
  bool color_ = false;
};

/// What the colour state makes of a stored colour of that format.
glm::vec4 stored_color(ColorFormat format, const ColorState& state, const glm::vec4& source,
                       const glm::vec4& stored);

}  // namespace gnomon::raster
