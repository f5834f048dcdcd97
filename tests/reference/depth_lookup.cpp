#include "reference/depth_lookup.h"

#include <algorithm>
#include <cmath>

#include "reference/float32.h"

namespace gnomon::reference {

namespace {

using namespace gnomon::raster;
using float32::over;
using float32::plus;
using float32::times;
__extension__ typedef __int128 Wide;

float or_zero(float v) { return v != v ? 0.0f : v; }

/// -1, 0 or 1 as `share` of `one` is less than, equal to or greater than `units`, exactly.
int order(float share, std::uint32_t one, std::uint32_t units) {
  if (share == 0.0f) return units == 0 ? 0 : -1;
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::frexp(share, &exponent) * 16777216.0f);
  const int shift = 24 - exponent;
  // Below 2^-56 of a unit.
  if (shift > 80) return units == 0 ? 1 : -1;
  const Wide left = static_cast<Wide>(mantissa) * one, right = static_cast<Wide>(units) << shift;
  return left < right ? -1 : left > right ? 1 : 0;
}

bool accepts(CompareFunc func, int relation) {
  const bool less = relation < 0, equal = relation == 0;
  switch (func) {
    case CompareFunc::never:
      return false;
    case CompareFunc::less:
      return less;
    case CompareFunc::equal:
      return equal;
    case CompareFunc::less_equal:
      return less || equal;
    case CompareFunc::greater:
      return !less && !equal;
    case CompareFunc::not_equal:
      return !equal;
    case CompareFunc::greater_equal:
      return !less;
    case CompareFunc::always:
      return true;
  }
  return false;
}

class Map {
 public:
  Map(const DepthLookup& lookup, float r) : lookup_(lookup), r_(r) {}

  /// 1 if the comparison with texel (x, y) holds, else 0.
  float at(double x, double y) const {
    const DepthBuffer& map = *lookup_.map;
    const double right = map.width() - 1, top = map.height() - 1;
    int relation = 0;
    if (lookup_.border && (x < 0 || y < 0 || x > right || y > top)) {
      const float border = std::clamp(or_zero(*lookup_.border), 0.0f, 1.0f);
      relation = r_ < border ? -1 : r_ > border ? 1 : 0;
    } else {
      const int i = static_cast<int>(std::clamp(x, 0.0, right));
      const int j = static_cast<int>(std::clamp(y, 0.0, top));
      relation = order(r_, map.max_value(), map.at(i, j));
    }
    return accepts(lookup_.func, relation) ? 1.0f : 0.0f;
  }

 private:
  const DepthLookup& lookup_;
  float r_;
};

float mixed(float a, float b, float t) { return plus(times(a, plus(1.0f, -t)), times(b, t)); }

}  // namespace

float compare_depth(const DepthLookup& lookup, const glm::vec4& p) {
  const auto row = [&](int i) {
    const glm::mat4& m = lookup.map_from_position;
    return plus(plus(plus(times(m[0][i], p.x), times(m[1][i], p.y)), times(m[2][i], p.z)),
                times(m[3][i], p.w));
  };
  const float q = row(3);
  // Coordinates so large are on the border or the edge whatever their last bits are.
  const float far = 1e9f;
  const auto texels = [&](float coordinate, int size) {
    return std::clamp(or_zero(times(over(coordinate, q), static_cast<float>(size))), -far, far);
  };
  const float u = texels(row(0), lookup.map->width()), v = texels(row(1), lookup.map->height());
  const Map map(lookup, std::clamp(or_zero(over(row(2), q)), 0.0f, 1.0f));
  if (lookup.filter == Filter::nearest) return map.at(std::floor(u), std::floor(v));
  const float from_u = plus(u, -0.5f), from_v = plus(v, -0.5f);
  const float x = std::floor(from_u), y = std::floor(from_v);
  const float right = plus(from_u, -x), up = plus(from_v, -y);
  const double x0 = x, y0 = y;
  return mixed(mixed(map.at(x0, y0), map.at(x0 + 1, y0), right),
               mixed(map.at(x0, y0 + 1), map.at(x0 + 1, y0 + 1), right), up);
}

}  // namespace gnomon::reference
