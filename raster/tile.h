// One 64x64 tile of a frame: commands in recorded order over the tile's pixels. A tile is one job;
// nothing else touches its pixels.
#pragma once

#include <optional>

#include "raster/frame.h"
#include "raster/geometry.h"
#include "raster/kernels.h"

namespace gnomon::raster {

/// A tile's coordinates, in tiles.
struct TileIndex {
  int x = 0, y = 0;
};

void clear_tile(const Kernels& kernels, const Clear& clear, const Targets& targets,
                TileIndex tile) noexcept;
void blit_tile(const Kernels& kernels, const Blit& blit, const Targets& targets,
               TileIndex tile) noexcept;

/// What the fragments of a draw share, resolved once a draw.
struct FragmentSetup {
  FragmentTests front, back;
  /// Colour reaches a target.
  bool color = false;
  /// The colour of all fragments, if they have one.
  std::optional<glm::vec4> constant;
};

FragmentSetup make_fragment_setup(const Draw& draw, const Targets& targets);

/// Draws one triangle's pixels inside the tile.
void draw_tile(const Kernels& kernels, const DrawSetup& setup, const FragmentSetup& fragments,
               const SetupTriangle& triangle, const Targets& targets, TileIndex tile) noexcept;

}  // namespace gnomon::raster
