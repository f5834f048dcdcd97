#include "raster/select_triangles.h"

#include <algorithm>
#include <array>

#include "raster/geometry.h"

namespace gnomon::raster {

namespace {

/// First pixel whose centre is at or after a 24.8 coordinate.
int first_pixel(std::int32_t fx) { return (fx + 127) >> 8; }
/// One past the last pixel whose centre is at or before it.
int end_pixel(std::int32_t fx) { return ((fx - 128) >> 8) + 1; }

/// The pixels of a tiny box whose centres the triangle, of this winding, covers.
TinyPixels covered_pixels(const std::array<SnappedVertex, 3>& corners, bool clockwise,
                          const PixelBox& box) {
  SetupTriangle triangle;
  triangle.vertices = {corners[0], corners[clockwise ? 2 : 1], corners[clockwise ? 1 : 2]};
  triangle.x0 = static_cast<std::int16_t>(box.x0);
  triangle.y0 = static_cast<std::int16_t>(box.y0);
  triangle.x1 = static_cast<std::int16_t>(box.x1);
  triangle.y1 = static_cast<std::int16_t>(box.y1);
  unsigned pixels = 0;
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x)
      if (triangle.covers(x, y)) pixels |= 1u << (kTinyBox * (y - box.y0) + (x - box.x0));
  return static_cast<TinyPixels>(pixels);
}

}  // namespace

void select_triangles(const TriangleSelector& selector, const std::uint32_t* indices,
                      std::size_t count, TriangleBatch& out) noexcept {
  out.clipped = out.kept = out.clockwise = out.small = out.planes = 0;
  for (std::size_t t = 0; t < count; ++t) {
    const TriangleMask bit = TriangleMask{1} << t;
    std::array<SnappedVertex, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t i = indices[3 * t + k];
      corners[k] = {selector.x_fx[i], selector.y_fx[i]};
    }
    const auto& [a, b, c] = corners;
    const auto [x_min, x_max] = std::minmax({a.x_fx, b.x_fx, c.x_fx});
    if (x_min == kClipped) {
      out.clipped |= bit;
      continue;
    }
    const auto [y_min, y_max] = std::minmax({a.y_fx, b.y_fx, c.y_fx});
    const std::int64_t area = doubled_area(a, b, c);
    const bool clockwise = area < 0;
    if (area == 0 || !(clockwise ? selector.keeps_cw : selector.keeps_ccw)) continue;
    const PixelBox box = intersect(
        selector.box, {first_pixel(x_min), first_pixel(y_min), end_pixel(x_max), end_pixel(y_max)});
    if (box.empty()) continue;
    const bool small = x_max - x_min < kSmallExtent && y_max - y_min < kSmallExtent;
    const bool tiny = small && box.x1 - box.x0 <= kTinyBox && box.y1 - box.y0 <= kTinyBox;
    const TinyPixels pixels = tiny ? covered_pixels(corners, clockwise, box) : TinyPixels{0};
    if (tiny && !pixels) continue;
    out.kept |= bit;
    if (clockwise) out.clockwise |= bit;
    if (small) out.small |= bit;
    out.area[t] = static_cast<double>(area);
    out.pixels[t] = pixels;
    out.x0[t] = box.x0;
    out.y0[t] = box.y0;
    out.x1[t] = box.x1;
    out.y1[t] = box.y1;
  }
}

}  // namespace gnomon::raster
