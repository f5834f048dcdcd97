// A rectangle of pixels.
#pragma once

namespace gnomon::raster {

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

}  // namespace gnomon::raster
