// Buffers of raster/ as pictures for people.
#pragma once

#include "ar/image.h"
#include "raster/frame_format.h"

namespace gnomon::ar {

/// From the top row. Colour: r, g, b; floats are clamped to [0, 1] and rounded. Depth: grey, nearer
/// is lighter (depth_picture). Stencil: false colour with a legend (stencil_picture).
Image buffer_picture(const raster::Buffer& buffer);
Image buffer_picture(const raster::ColorBuffer& color);
Image buffer_picture(const raster::DepthBuffer& depth);
Image buffer_picture(const raster::StencilBuffer& stencil);

}  // namespace gnomon::ar
