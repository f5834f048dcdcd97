// Clears and blits inside one 64x64 tile. A tile is one job; nothing else touches its pixels.
#pragma once

#include "raster/frame.h"
#include "raster/tile_pixels.h"

namespace gnomon::raster {

void clear_tile(const Clear& clear, TilePixels& pixels) noexcept;
void blit_tile(const Blit& blit, TilePixels& pixels) noexcept;

}  // namespace gnomon::raster
