// A draw's shading put together for the vector kernel (Kernels::shade_block), for shadings that
// need neither texture nor lookup.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "raster/frame.h"
#include "raster/geometry.h"
#include "raster/kernels.h"

namespace gnomon::raster {

/// What all blocks of a draw share.
struct DrawShading {
  std::optional<BlockLit> lit;
  std::vector<BlockLight> lights;
  /// With `lit`, back faces are lit with the reversed normal.
  bool two_sided = false;
};

/// Absent if the draw is shaded pixel by pixel.
std::optional<DrawShading> make_draw_shading(const Draw& draw);

/// A triangle's part that all of its blocks share; weights' edges are set by set_block.
BlockShading make_triangle_shading(const Draw& draw, const DrawShading& shading,
                                   const SetupTriangle& triangle,
                                   std::span<const PieceWeights> pieces);

/// Moves the weights to the block whose first pixel is (x, y).
void set_block(const SetupTriangle& triangle, int x, int y, BlockShading& shading);

}  // namespace gnomon::raster
