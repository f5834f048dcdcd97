#include "raster/depth_plane.h"

#include <algorithm>
#include <cmath>

#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

Int128 magnitude(Int128 value) { return value < 0 ? -value : value; }

/// Differences of the vertices from the first one.
struct Sides {
  std::int64_t dx1, dy1, dz1, dx2, dy2, dz2;

  explicit Sides(const std::array<SnappedVertex, 3>& v)
      : dx1(v[1].x_fx - v[0].x_fx),
        dy1(v[1].y_fx - v[0].y_fx),
        dz1(v[1].z_fx - v[0].z_fx),
        dx2(v[2].x_fx - v[0].x_fx),
        dy2(v[2].y_fx - v[0].y_fx),
        dz2(v[2].z_fx - v[0].z_fx) {}

  /// The slopes below fit 62 bits: coordinates are at most 2^25 apart.
  bool is_shallow() const {
    constexpr std::int64_t kShallow = std::int64_t{1} << 35;
    return std::abs(dz1) < kShallow && std::abs(dz2) < kShallow;
  }
  /// Change of depth a 1/256 pixel, times the area.
  template <class Integer>
  Integer slope_x() const {
    return static_cast<Integer>(dz1) * dy2 - static_cast<Integer>(dz2) * dy1;
  }
  template <class Integer>
  Integer slope_y() const {
    return static_cast<Integer>(dx1) * dz2 - static_cast<Integer>(dx2) * dz1;
  }
};

/// numerator / area to the nearest integer, modulo 2^64.
std::uint64_t quotient(Int128 numerator, std::int64_t area) {
  return static_cast<std::uint64_t>(round_div(numerator, area));
}

/// slope * 256 / area to the nearest integer, modulo 2^64, for a shallow slope.
std::uint64_t step_of(std::int64_t slope, std::int64_t area) {
  const double estimate = static_cast<double>(slope) * 256.0 / static_cast<double>(area);
  if (!(std::abs(estimate) < kLargestEstimate)) return quotient(Int128{slope} * 256, area);
  return round_div_near(static_cast<std::uint64_t>(slope) * 256, area, estimate);
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

bool is_narrow(const std::array<SnappedVertex, 3>& vertices, std::int64_t offset,
               DepthFormat format, std::uint32_t low, std::uint32_t high) {
  const int fraction_bits = depth_fraction_bits(format);
  const auto [z_min, z_max] = std::minmax({vertices[0].z_fx, vertices[1].z_fx, vertices[2].z_fx});
  return z_min + offset >= static_cast<std::int64_t>(low) << fraction_bits &&
         z_max + offset <= static_cast<std::int64_t>(high) << fraction_bits;
}

DepthPlane make_depth_plane(const std::array<SnappedVertex, 3>& vertices, std::int64_t area,
                            const std::optional<PolygonOffset>& offset, DepthFormat format,
                            std::uint32_t low, std::uint32_t high) {
  const Sides sides(vertices);
  const int fraction_bits = depth_fraction_bits(format);
  DepthPlane plane;
  if (sides.is_shallow()) {
    plane.step_x = step_of(sides.slope_x<std::int64_t>(), area);
    plane.step_y = step_of(sides.slope_y<std::int64_t>(), area);
  } else {
    plane.step_x = quotient(sides.slope_x<Int128>() * 256, area);
    plane.step_y = quotient(sides.slope_y<Int128>() * 256, area);
  }
  if (offset) {
    // Not the steps: a large factor would multiply their rounding.
    const Int128 largest =
        std::max(magnitude(sides.slope_x<Int128>()), magnitude(sides.slope_y<Int128>()));
    const double slope = static_cast<double>(largest) * 256.0 / static_cast<double>(area);
    plane.offset = offset_in_plane_units(*offset, slope, fraction_bits);
  }
  plane.narrow = is_narrow(vertices, plane.offset, format, low, high);
  return plane;
}

std::uint64_t depth_base_at(const std::array<SnappedVertex, 3>& vertices, std::int64_t area,
                            int x_px, int y_px) {
  const Sides sides(vertices);
  const std::int64_t dx = x_px * std::int64_t{256} + 128 - vertices[0].x_fx;
  const std::int64_t dy = y_px * std::int64_t{256} + 128 - vertices[0].y_fx;
  const auto anchor = static_cast<std::uint64_t>(vertices[0].z_fx);
  if (sides.is_shallow()) {
    const auto slope_x = sides.slope_x<std::int64_t>(), slope_y = sides.slope_y<std::int64_t>();
    // Both products are below 2^87, so their rounding in double is below 2^36.
    const double estimate = (static_cast<double>(slope_x) * static_cast<double>(dx) +
                             static_cast<double>(slope_y) * static_cast<double>(dy)) /
                            static_cast<double>(area);
    if (std::abs(estimate) < kLargestEstimate)
      return anchor + round_div_near(
                          static_cast<std::uint64_t>(slope_x) * static_cast<std::uint64_t>(dx) +
                              static_cast<std::uint64_t>(slope_y) * static_cast<std::uint64_t>(dy),
                          area, estimate);
  }
  return anchor + quotient(sides.slope_x<Int128>() * dx + sides.slope_y<Int128>() * dy, area);
}

}  // namespace gnomon::raster
