// Stencil counts as text, the way one sees them: the top row first, one character a pixel.
//
//   .        0
//   1 to 9   1 to 9
//   a to z   10 to 35
//   A to Z   -1 to -26, counts that wrapped below zero: A is 255, B is 254, Z is 230
//   #        36 to 229; names no one value
#pragma once

#include <cstdint>
#include <string>

#include "raster/buffers.h"
#include "raster/pixel_box.h"

namespace gnomon::raster {

/// The character of one value.
char stencil_glyph(std::uint8_t value);

/// The rows of a box, each ended by a newline. Precondition: the box lies inside the buffer.
std::string stencil_text(const StencilBuffer& stencil, const PixelBox& box);

}  // namespace gnomon::raster
