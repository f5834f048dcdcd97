// The buffers of a drawn view as pictures in the photograph's own geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ar/image.h"
#include "ar/pinhole_view.h"
#include "raster/buffers.h"

namespace gnomon::ar {

/// A mask of the view (rows r, g, b, a from the bottom row): 255 where at least half of a pixel's
/// area belongs to it, else 0. The same for every number of threads.
Image mask_at_photo(const PinholeView& view, const std::vector<std::uint8_t>& rgba_rows,
                    std::size_t channel, int threads = 0);

/// Three channels, clamped and rounded to 8 bits.
Image color_at_photo(const PinholeView& view, const raster::ColorBuffer& color);
Image stencil_at_photo(const PinholeView& view, const raster::StencilBuffer& stencil);
Image depth_at_photo(const PinholeView& view, const raster::DepthBuffer& depth);

}  // namespace gnomon::ar
