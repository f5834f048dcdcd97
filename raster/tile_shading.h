// A draw's shading put together for the vector kernel (Kernels::shade_and_store), for shadings
// without texture.
#pragma once

#include <memory_resource>
#include <optional>
#include <span>
#include <vector>

#include "raster/frame.h"
#include "raster/geometry.h"
#include "raster/kernels.h"

namespace gnomon::raster {

/// A flat colour's depth lookup and the channels that it scales.
struct FlatLookup {
  LookupTerms terms{};
  bool scales_rgb = false, scales_alpha = false;
  /// A pixel for which its share is 0 keeps its colour, in float32 if weights are not negative.
  bool zero_keeps = false, is_rgba8 = false;
  /// Of the map's blocks, row after row, if they are of use.
  std::pmr::vector<LookupRange> ranges;

  /// Every fragment between the positions with these indices keeps its pixel's colour, of triangles
  /// that are not cut; false also where that is not found out.
  bool leaves_no_mark(const Kernels& kernels, const glm::vec4* positions,
                      const std::uint32_t* index, int count) const;
};

/// What all blocks of a draw share.
struct DrawShading {
  std::optional<FlatLookup> lookup;
  std::optional<LitTerms> lit;
  std::pmr::vector<LitLight> lights;
  /// With `lit`, back faces are lit with the reversed normal.
  bool two_sided = false;
};

/// Absent if the draw is shaded pixel by pixel. `memory` outlives the result.
/// Precondition: there is a colour target.
std::optional<DrawShading> make_draw_shading(const Draw& draw, const Targets& targets,
                                             const Kernels& kernels,
                                             std::pmr::memory_resource& memory);

/// A triangle's shading in the tile whose first pixel is (x, y).
TileShading make_tile_shading(const Draw& draw, const DrawShading& shading,
                              const SetupTriangle& triangle, const TriangleSource& source, int x,
                              int y);

}  // namespace gnomon::raster
