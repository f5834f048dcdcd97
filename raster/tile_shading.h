// A draw's shading put together for the vector kernel (Kernels::shade_block), for shadings that
// need neither texture nor lookup.
#pragma once

#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "raster/frame.h"
#include "raster/geometry.h"
#include "raster/kernels.h"

namespace gnomon::raster {

/// What all blocks of a draw share.
struct DrawShading {
  std::optional<LitTerms> lit;
  std::pmr::vector<LitLight> lights;
  /// With `lit`, back faces are lit with the reversed normal.
  bool two_sided = false;
};

/// Absent if the draw is shaded pixel by pixel. `memory` outlives the result, which may be moved
/// but not copied: `lit` points at `lights`.
std::optional<DrawShading> make_draw_shading(const Draw& draw, std::pmr::memory_resource& memory);

/// A triangle's shading in the tile whose first pixel is (x, y).
TileShading make_tile_shading(const Draw& draw, const DrawShading& shading,
                              const SetupTriangle& triangle, const TriangleSource& source, int x,
                              int y);

}  // namespace gnomon::raster
