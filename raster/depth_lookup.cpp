#include "raster/depth_lookup.h"

#include <algorithm>
#include <cmath>

#include "raster/compare_func.h"

namespace gnomon::raster {

namespace {

float row(const glm::mat4& m, int i, const glm::vec4& p) {
  return ((m[0][i] * p.x + m[1][i] * p.y) + m[2][i] * p.z) + m[3][i] * p.w;
}

/// In texels, far enough inside an int's range for its neighbours.
float texel_coordinate(float coordinate, int size) {
  constexpr float kLimit = 1073741824.0f;
  const float scaled = coordinate * static_cast<float>(size);
  return std::isnan(scaled) ? 0.0f : std::clamp(scaled, -kLimit, kLimit);
}

/// What a texel is compared with: depth units, exact (24 bits of float32 times 24 bits).
double reference_units(float r, double one) {
  return std::isnan(r) ? 0.0 : static_cast<double>(std::clamp(r, 0.0f, 1.0f)) * one;
}

/// 1 or 0 for texel (x, y), which may lie outside.
float passes(const DepthLookup& lookup, int x, int y, double reference) {
  const DepthBuffer& map = *lookup.map;
  const bool inside = x >= 0 && y >= 0 && x < map.width() && y < map.height();
  const double one = map.max_value();
  const double texel = inside || !lookup.border ? map.at(std::clamp(x, 0, map.width() - 1),
                                                         std::clamp(y, 0, map.height() - 1))
                                                : reference_units(*lookup.border, one);
  return holds(lookup.func, reference, texel) ? 1.0f : 0.0f;
}

}  // namespace

float compare_depth(const DepthLookup& lookup, const glm::vec4& position) {
  const glm::mat4& m = lookup.map_from_position;
  const float q = row(m, 3, position);
  float u = texel_coordinate(row(m, 0, position) / q, lookup.map->width());
  float v = texel_coordinate(row(m, 1, position) / q, lookup.map->height());
  const double reference = reference_units(row(m, 2, position) / q, lookup.map->max_value());
  if (lookup.filter == Filter::nearest)
    return passes(lookup, static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)),
                  reference);
  u = u - 0.5f;
  v = v - 0.5f;
  const float u0 = std::floor(u), v0 = std::floor(v);
  const float fu = u - u0, fv = v - v0;
  const int x = static_cast<int>(u0), y = static_cast<int>(v0);
  const float bottom =
      passes(lookup, x, y, reference) * (1.0f - fu) + passes(lookup, x + 1, y, reference) * fu;
  const float top = passes(lookup, x, y + 1, reference) * (1.0f - fu) +
                    passes(lookup, x + 1, y + 1, reference) * fu;
  return bottom * (1.0f - fv) + top * fv;
}

}  // namespace gnomon::raster
