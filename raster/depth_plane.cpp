#include "raster/depth_plane.h"

#include <algorithm>
#include <cmath>

#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

Int128 magnitude(Int128 value) { return value < 0 ? -value : value; }

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

std::uint64_t DepthPlane::base_at(int x_px, int y_px) const {
  const Int128 dx = static_cast<Int128>(x_px) * 256 + 128 - anchor.x_fx;
  const Int128 dy = static_cast<Int128>(y_px) * 256 + 128 - anchor.y_fx;
  const Int128 rise = round_div(numerator_x * dx + numerator_y * dy, area);
  return static_cast<std::uint64_t>(rise + anchor.z_fx + offset);
}

std::pair<double, double> DepthPlane::range(int x_px, int y_px, int span,
                                            DepthFormat format) const {
  const double one = static_cast<double>(std::int64_t{1} << depth_fraction_bits(format));
  const double dx = x_px + 0.5 - anchor.x_fx / 256.0, dy = y_px + 0.5 - anchor.y_fx / 256.0;
  const double rise_x = slope_x * dx, rise_y = slope_y * dy;
  const double here = static_cast<double>(anchor.z_fx + offset) + (rise_x + rise_y);
  // A product has a relative error of a few 2^-53, and the depth that is stored is within one unit
  // of the exact one.
  const double across = (std::abs(slope_x) + std::abs(slope_y)) * span;
  const double error =
      (std::abs(rise_x) + std::abs(rise_y) + std::abs(here) + across) * 0x1p-48 + one;
  const double low = here + (std::min(slope_x, 0.0) + std::min(slope_y, 0.0)) * span - error;
  const double high = here + (std::max(slope_x, 0.0) + std::max(slope_y, 0.0)) * span + error;
  return {std::floor(std::max(low, least - one) / one),
          std::ceil(std::min(high, greatest + one) / one)};
}

DepthPlane make_depth_plane(const std::array<SnappedVertex, 3>& vertices, std::int64_t area,
                            const std::optional<PolygonOffset>& offset, DepthFormat format,
                            std::uint32_t low, std::uint32_t high) {
  const auto& [v0, v1, v2] = vertices;
  const Int128 dx1 = v1.x_fx - v0.x_fx, dy1 = v1.y_fx - v0.y_fx, dz1 = v1.z_fx - v0.z_fx;
  const Int128 dx2 = v2.x_fx - v0.x_fx, dy2 = v2.y_fx - v0.y_fx, dz2 = v2.z_fx - v0.z_fx;
  const Int128 sign = area < 0 ? -1 : 1;

  DepthPlane plane;
  plane.anchor = v0;
  plane.area = area < 0 ? -area : area;
  plane.numerator_x = sign * (dz1 * dy2 - dz2 * dy1);
  plane.numerator_y = sign * (dx1 * dz2 - dx2 * dz1);
  plane.step_x = static_cast<std::uint64_t>(round_div(plane.numerator_x * 256, plane.area));
  plane.step_y = static_cast<std::uint64_t>(round_div(plane.numerator_y * 256, plane.area));

  const int fraction_bits = depth_fraction_bits(format);
  if (offset) {
    // Not the steps: a large factor would multiply their rounding.
    const Int128 largest = std::max(magnitude(plane.numerator_x), magnitude(plane.numerator_y));
    const double slope = static_cast<double>(largest) * 256.0 / static_cast<double>(plane.area);
    plane.offset = offset_in_plane_units(*offset, slope, fraction_bits);
  }
  const auto [z_min, z_max] = std::minmax({v0.z_fx, v1.z_fx, v2.z_fx});
  plane.slope_x = static_cast<double>(plane.numerator_x) * 256.0 / static_cast<double>(plane.area);
  plane.slope_y = static_cast<double>(plane.numerator_y) * 256.0 / static_cast<double>(plane.area);
  plane.least = static_cast<double>(z_min + plane.offset);
  plane.greatest = static_cast<double>(z_max + plane.offset);
  plane.narrow = z_min + plane.offset >= static_cast<std::int64_t>(low) << fraction_bits &&
                 z_max + plane.offset <= static_cast<std::int64_t>(high) << fraction_bits;
  return plane;
}

}  // namespace gnomon::raster
