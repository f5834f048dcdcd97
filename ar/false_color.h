// Pictures of buffers for people: stencil counts in a palette that colour-blind people can tell
// apart, with a legend; depth as grey.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ar/image.h"

namespace gnomon::ar {

/// The colour of a stencil value: 0 is near black, small counts run through a blue-to-yellow scale
/// of equal steps in lightness, counts from 16 to 127 stay at its end, and values from 128 (a count
/// that went below 0, as a signed byte) are reds.
std::array<std::uint8_t, 3> stencil_color(std::uint8_t value);

/// Stencil values (rows from the top) in false colour, with a legend at the right: each value that
/// occurs (the smallest, where the picture's height has no room for all), what it means as a signed
/// count, and how many pixels have it. Three channels, wider than the input.
Image stencil_picture(int width, int height, const std::vector<std::uint8_t>& stencil);

/// Depth (rows from the top) as grey: the nearest value that occurs is white, the farthest dark,
/// what is at `farthest` (cleared) black.
Image depth_picture(int width, int height, const std::vector<std::uint32_t>& depth,
                    std::uint32_t farthest);

}  // namespace gnomon::ar
