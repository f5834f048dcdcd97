// Clears and blits inside one 64x64 tile. A tile is one job; nothing else touches its pixels.
#pragma once

#include "raster/frame.h"
#include "raster/kernels.h"
#include "raster/tile_blocks.h"

namespace gnomon::raster {

void clear_tile(const Kernels& kernels, const Clear& clear, const Targets& targets,
                TileIndex tile) noexcept;
void blit_tile(const Kernels& kernels, const Blit& blit, const Targets& targets,
               TileIndex tile) noexcept;

}  // namespace gnomon::raster
