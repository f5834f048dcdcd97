// Stencil counts as text (raster/stencil_text.h), and back: # is written but never read, because it
// names no one value.
#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "raster/buffers.h"

namespace gnomon::testing {

/// The buffer's rows, each ended by a newline.
std::string to_text(const raster::StencilBuffer& stencil);

/// The buffer that a text shows. Spaces, tabs and empty lines do not count, so a raw string may be
/// indented. Throws std::invalid_argument that names the place if a character stands for no value,
/// rows differ in length, or there is no pixel.
raster::StencilBuffer stencil_of(std::string_view text);

}  // namespace gnomon::testing

namespace gnomon::raster {

/// What GoogleTest prints: size, format and range of values; of a stencil buffer of up to 64x32
/// pixels also the counts.
void PrintTo(const StencilBuffer& stencil, std::ostream* out);
void PrintTo(const DepthBuffer& depth, std::ostream* out);
void PrintTo(const ColorBuffer& color, std::ostream* out);

}  // namespace gnomon::raster
