#include "raster/select_triangles.h"

#include <algorithm>

#include "raster/geometry.h"

namespace gnomon::raster {

namespace {

/// First pixel whose centre is at or after a 24.8 coordinate.
int first_pixel(std::int32_t fx) { return (fx + 127) >> 8; }
/// One past the last pixel whose centre is at or before it.
int end_pixel(std::int32_t fx) { return ((fx - 128) >> 8) + 1; }

/// The corners of one triangle.
struct Corners {
  std::int32_t x[3], y[3];

  std::int64_t area() const {
    return std::int64_t{x[1] - x[0]} * (y[2] - y[0]) - std::int64_t{x[2] - x[0]} * (y[1] - y[0]);
  }
  Edge edge(int from, int to) const { return {y[from] - y[to], x[to] - x[from], x[from], y[from]}; }
};

bool holds_a_center(const Corners& corners, bool clockwise, const PixelBox& box) {
  const int second = clockwise ? 2 : 1, third = clockwise ? 1 : 2;
  const Edge edges[3] = {corners.edge(second, third), corners.edge(third, 0),
                         corners.edge(0, second)};
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      if (std::all_of(edges, edges + 3, [&](const Edge& edge) {
            return edge.at(x * std::int64_t{256} + 128, y * std::int64_t{256} + 128) >= edge.bias();
          }))
        return true;
    }
  }
  return false;
}

}  // namespace

void select_triangles(const TriangleSelector& selector, const std::uint32_t* indices,
                      std::size_t count, TriangleBatch& out) noexcept {
  out.clipped = out.kept = out.clockwise = out.small = out.planes = 0;
  for (std::size_t t = 0; t < count; ++t) {
    const TriangleMask bit = TriangleMask{1} << t;
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners.x[k] = selector.x_fx[indices[3 * t + k]];
      corners.y[k] = selector.y_fx[indices[3 * t + k]];
    }
    const auto [x_min, x_max] = std::minmax({corners.x[0], corners.x[1], corners.x[2]});
    if (x_min == kClipped) {
      out.clipped |= bit;
      continue;
    }
    const auto [y_min, y_max] = std::minmax({corners.y[0], corners.y[1], corners.y[2]});
    const std::int64_t area = corners.area();
    const bool clockwise = area < 0;
    if (area == 0 || !(clockwise ? selector.keeps_cw : selector.keeps_ccw)) continue;
    const PixelBox box = intersect(
        selector.box, {first_pixel(x_min), first_pixel(y_min), end_pixel(x_max), end_pixel(y_max)});
    if (box.empty()) continue;
    const bool small = x_max - x_min < kSmallExtent && y_max - y_min < kSmallExtent;
    const bool tiny = small && box.x1 - box.x0 <= kTinyBox && box.y1 - box.y0 <= kTinyBox;
    if (tiny && !holds_a_center(corners, clockwise, box)) continue;
    out.kept |= bit;
    if (clockwise) out.clockwise |= bit;
    if (small) out.small |= bit;
    out.area[t] = static_cast<double>(area);
    out.x0[t] = box.x0;
    out.y0[t] = box.y0;
    out.x1[t] = box.x1;
    out.y1[t] = box.y1;
  }
}

}  // namespace gnomon::raster
