// One 64x64 tile of a frame: commands in recorded order over the tile's pixels. A tile is one job;
// nothing else touches its pixels.
#pragma once

#include <cstdint>
#include <span>

#include "raster/frame.h"
#include "raster/geometry.h"

namespace gnomon::raster {

/// A tile's coordinates, in tiles.
struct TileIndex {
  int x = 0, y = 0;
};

void clear_tile(const Clear& clear, const Targets& targets, TileIndex tile) noexcept;
void blit_tile(const Blit& blit, const Targets& targets, TileIndex tile) noexcept;

/// Draws one triangle's pixels inside the tile.
void draw_tile(const DrawSetup& setup, const SetupTriangle& triangle, const Targets& targets,
               TileIndex tile) noexcept;

}  // namespace gnomon::raster
