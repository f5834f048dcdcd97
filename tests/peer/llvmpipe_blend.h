// llvmpipe's blending of unsigned normalized bytes (Mesa 22.3, lp_bld_blend.c and
// lp_build_mul_norm in lp_bld_arit.c). Unlike raster/blend.h it rounds each of the two products to
// a byte before it adds them, and its product (ab + (ab >> 8) + 128) >> 8 is one below the rounded
// quotient by 255 for 24 of the 65536 pairs.
#pragma once

#include "raster/buffers.h"
#include "raster/state.h"

namespace gnomon::peer {

/// The stored value after source is written over it, colour mask included.
raster::Rgba8 llvmpipe_blend(const raster::ColorState& state, const raster::Rgba8& source,
                             const raster::Rgba8& stored);

}  // namespace gnomon::peer
