#include "raster/depth_plane.h"

#include <algorithm>
#include <cmath>

#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

Int128 magnitude(Int128 value) { return value < 0 ? -value : value; }

/// Change of depth a 1/256 pixel, times the area.
struct Slopes {
  Int128 x, y;
};

/// Depth differences below this keep both products of a slope in 62 bits.
constexpr std::int64_t kShallow = std::int64_t{1} << 36;

Slopes slopes_times_area(const std::array<SnappedVertex, 3>& vertices) {
  const auto& [v0, v1, v2] = vertices;
  const std::int64_t dx1 = v1.x_fx - v0.x_fx, dy1 = v1.y_fx - v0.y_fx, dz1 = v1.z_fx - v0.z_fx;
  const std::int64_t dx2 = v2.x_fx - v0.x_fx, dy2 = v2.y_fx - v0.y_fx, dz2 = v2.z_fx - v0.z_fx;
  if (std::abs(dz1) < kShallow && std::abs(dz2) < kShallow)
    return {dz1 * dy2 - dz2 * dy1, dx1 * dz2 - dx2 * dz1};
  const Int128 wide1 = dz1, wide2 = dz2;
  return {wide1 * dy2 - wide2 * dy1, dx1 * wide2 - dx2 * wide1};
}

/// factor * largest slope + units, in plane units, to nearest; bounded so that sums with a vertex
/// depth stay in 64 bits. `slope` is the slope a pixel.
std::int64_t offset_in_plane_units(const PolygonOffset& offset, double slope, int fraction_bits) {
  const double one_unit = static_cast<double>(std::int64_t{1} << fraction_bits);
  const double value =
      static_cast<double>(offset.factor) * slope + static_cast<double>(offset.units) * one_unit;
  const double limit = static_cast<double>(kMaxVertexDepth);
  if (!(value > -limit)) return std::isnan(value) ? 0 : -kMaxVertexDepth;
  return value < limit ? round_to_nearest(value) : kMaxVertexDepth;
}

}  // namespace

DepthPlane make_depth_plane(const std::array<SnappedVertex, 3>& vertices, std::int64_t area,
                            const std::optional<PolygonOffset>& offset, DepthFormat format,
                            std::uint32_t low, std::uint32_t high) {
  Slopes slopes = slopes_times_area(vertices);
  if (area < 0) slopes = {-slopes.x, -slopes.y};
  area = std::abs(area);
  const double area_px = static_cast<double>(area);
  const double slope_x = static_cast<double>(slopes.x) * 256.0,
               slope_y = static_cast<double>(slopes.y) * 256.0;

  DepthPlane plane;
  plane.step_x = round_div_near(slopes.x * 256, area, slope_x / area_px);
  plane.step_y = round_div_near(slopes.y * 256, area, slope_y / area_px);

  const int fraction_bits = depth_fraction_bits(format);
  if (offset) {
    // Not the steps: a large factor would multiply their rounding.
    const Int128 largest = std::max(magnitude(slopes.x), magnitude(slopes.y));
    const double slope = static_cast<double>(largest) * 256.0 / area_px;
    plane.offset = offset_in_plane_units(*offset, slope, fraction_bits);
  }
  const auto [z_min, z_max] = std::minmax({vertices[0].z_fx, vertices[1].z_fx, vertices[2].z_fx});
  plane.narrow = z_min + plane.offset >= static_cast<std::int64_t>(low) << fraction_bits &&
                 z_max + plane.offset <= static_cast<std::int64_t>(high) << fraction_bits;
  return plane;
}

std::uint64_t depth_base_at(const std::array<SnappedVertex, 3>& vertices, std::int64_t area,
                            std::int64_t offset, int x_px, int y_px) {
  const Slopes slopes = slopes_times_area(vertices);
  const std::int64_t dx = x_px * std::int64_t{256} + 128 - vertices[0].x_fx;
  const std::int64_t dy = y_px * std::int64_t{256} + 128 - vertices[0].y_fx;
  const Int128 rise_times_area = slopes.x * dx + slopes.y * dy;
  const std::uint64_t rise = round_div_near(
      rise_times_area, area, static_cast<double>(rise_times_area) / static_cast<double>(area));
  return rise + static_cast<std::uint64_t>(vertices[0].z_fx + offset);
}

}  // namespace gnomon::raster
