// A borrowed 8-bit image. Row 0 is the bottom row, as in window coordinates; a picture that is
// stored from its top row is viewed with a negative stride (see from_top_row).
#pragma once

#include <cstddef>
#include <cstdint>

namespace gnomon::raster {

struct ImageView {
  /// First byte of the bottom row.
  const std::uint8_t* data = nullptr;
  int width = 0, height = 0;
  /// 3 (r, g, b; alpha reads 0) or 4 (r, g, b, a).
  int channels = 4;
  /// Bytes from a row to the one above it.
  std::ptrdiff_t stride = 0;

  /// A tightly packed picture whose first row in memory is its top row.
  static ImageView from_top_row(const std::uint8_t* top, int width, int height, int channels) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(width) * channels;
    return {top + row * (height - 1), width, height, channels, -row};
  }
  const std::uint8_t* pixel(int x, int y) const { return data + y * stride + x * channels; }
};

}  // namespace gnomon::raster
