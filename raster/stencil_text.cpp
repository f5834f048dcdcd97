#include "raster/stencil_text.h"

namespace gnomon::raster {

char stencil_glyph(std::uint8_t value) {
  if (value == 0) return '.';
  if (value < 10) return static_cast<char>('0' + value);
  if (value < 36) return static_cast<char>('a' + (value - 10));
  if (value >= 230) return static_cast<char>('A' + (255 - value));
  return '#';
}

std::string stencil_text(const StencilBuffer& stencil, const PixelBox& box) {
  std::string text;
  for (int y = box.y1 - 1; y >= box.y0; --y) {
    for (int x = box.x0; x < box.x1; ++x) text += stencil_glyph(stencil.at(x, y));
    text += '\n';
  }
  return text;
}

}  // namespace gnomon::raster
