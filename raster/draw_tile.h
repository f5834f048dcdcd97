// A triangle's pixels inside one 64x64 tile: which blocks it touches, which of those its depth
// decides as a whole, and the tests, stencil updates and colours of the rest.
#pragma once

#include <optional>

#include "raster/block_ranges.h"
#include "raster/frame.h"
#include "raster/geometry.h"
#include "raster/kernels.h"
#include "raster/tile_blocks.h"

namespace gnomon::raster {

/// What the fragments of a draw share, resolved once a draw.
struct FragmentSetup {
  FragmentTests front, back;
  /// Colour reaches a target.
  bool color = false;
  /// The colour of all fragments, if they have one.
  std::optional<glm::vec4> constant;
};

FragmentSetup make_fragment_setup(const Draw& draw, const Targets& targets);

/// Draws the triangle's pixels inside the tile. `ranges` are those of the targets' depth buffer.
void draw_tile(const Kernels& kernels, const DrawSetup& setup, const FragmentSetup& fragments,
               const SetupTriangle& triangle, const Targets& targets, TileIndex tile,
               BlockRanges& ranges) noexcept;

}  // namespace gnomon::raster
