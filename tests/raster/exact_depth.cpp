#include "exact_depth.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "raster/clip.h"
#include "raster/unorm.h"

namespace gnomon::exact_depth {

using namespace gnomon::raster;

namespace {

/// The offset's factor and units are counted in quarters.
constexpr int kQuarters = 4;

/// An integer whose arithmetic throws where 128 bits are too few.
struct Checked {
  Int128 value;

  Checked(Int128 v) : value(v) {}  // NOLINT(google-explicit-constructor): stands for the integer

  friend Checked operator*(Checked a, Checked b) {
    Int128 out;
    if (__builtin_mul_overflow(a.value, b.value, &out)) overflow();
    return out;
  }
  friend Checked operator+(Checked a, Checked b) {
    Int128 out;
    if (__builtin_add_overflow(a.value, b.value, &out)) overflow();
    return out;
  }
  friend Checked operator-(Checked a, Checked b) { return a + b * Int128{-1}; }

 private:
  [[noreturn]] static void overflow() {
    throw std::overflow_error("an exact depth does not fit 128 bits");
  }
};

Checked magnitude(Checked v) { return v.value < 0 ? v * Int128{-1} : v; }
Checked larger(Checked a, Checked b) { return a.value > b.value ? a : b; }

Int128 quarters(float value) {
  const double scaled = static_cast<double>(value) * kQuarters;
  if (scaled != std::floor(scaled) || std::abs(scaled) > 1e9)
    throw std::invalid_argument("an exact offset is a multiple of 1/4");
  return static_cast<Int128>(scaled);
}

/// Adds the view's offset and bounds. A plane's steps and `one` hold four times what they stand
/// for.
Plane finished(Plane plane, const View& view) {
  if (view.offset) {
    const Checked steepest = larger(magnitude(plane.step_x), magnitude(plane.step_y));
    if (steepest.value % kQuarters != 0 || plane.one % kQuarters != 0)
      throw std::logic_error("a plane is counted in quarters");
    plane.origin =
        (Checked(plane.origin) + Checked(quarters(view.offset->factor)) * (steepest.value / 4) +
         Checked(quarters(view.offset->units)) * (plane.one / 4))
            .value;
  }
  const std::uint32_t full = max_depth(view.format);
  const auto [near, far] = std::minmax(view.range.near, view.range.far);
  plane.low = (Checked(view.clamp ? float_to_depth(near, view.format) : 0) * plane.one).value;
  plane.high = (Checked(view.clamp ? float_to_depth(far, view.format) : full) * plane.one).value;
  // Linear, so largest at a corner of the target; with the stored value's share on top.
  for (const int x : {0, view.width})
    for (const int y : {0, view.height}) {
      const Checked value =
          Checked(plane.origin) + Checked(plane.step_x) * x + Checked(plane.step_y) * y;
      (void)(magnitude(value) + Checked(full) * plane.one);
    }
  return plane;
}

std::int64_t nearest(double value) { return std::llrint(value); }

SnappedVertex snapped(const glm::dvec4& clip, const View& view) {
  constexpr double kMaxCoordinate = 1 << 24;
  const double half_width = view.width * 0.5, half_height = view.height * 0.5;
  const double near = view.range.near, far = view.range.far;
  const double x = (clip.x / clip.w) * half_width + half_width;
  const double y = (clip.y / clip.w) * half_height + half_height;
  const double z = (clip.z / clip.w) * ((far - near) * 0.5) + (far + near) * 0.5;
  const double one = std::ldexp(max_depth(view.format), depth_fraction_bits(view.format));
  const auto limit = static_cast<double>(kMaxVertexDepth);
  SnappedVertex out;
  out.x_fx =
      static_cast<std::int32_t>(nearest(std::clamp(x * 256.0, -kMaxCoordinate, kMaxCoordinate)));
  out.y_fx =
      static_cast<std::int32_t>(nearest(std::clamp(y * 256.0, -kMaxCoordinate, kMaxCoordinate)));
  out.z_fx =
      nearest(view.clamp ? std::clamp(z * one, -limit, limit) : std::clamp(z * one, 0.0, one));
  return out;
}

std::int64_t area(const std::array<SnappedVertex, 3>& v) {
  return static_cast<std::int64_t>(v[1].x_fx - v[0].x_fx) * (v[2].y_fx - v[0].y_fx) -
         static_cast<std::int64_t>(v[2].x_fx - v[0].x_fx) * (v[1].y_fx - v[0].y_fx);
}

Plane snapped_plane(const std::array<SnappedVertex, 3>& v, const View& view) {
  const Int128 dx1 = v[1].x_fx - v[0].x_fx, dy1 = v[1].y_fx - v[0].y_fx;
  const Int128 dx2 = v[2].x_fx - v[0].x_fx, dy2 = v[2].y_fx - v[0].y_fx;
  const Int128 dz1 = v[1].z_fx - v[0].z_fx, dz2 = v[2].z_fx - v[0].z_fx;
  const Checked a = area(v);
  const Checked rise_x = Checked(dz1) * dy2 - Checked(dz2) * dy1;
  const Checked rise_y = Checked(dx1) * dz2 - Checked(dx2) * dz1;
  const Checked scale = kQuarters;
  Plane plane;
  plane.one = (scale * a * (Int128{1} << depth_fraction_bits(view.format))).value;
  plane.step_x = (scale * rise_x * 256).value;
  plane.step_y = (scale * rise_y * 256).value;
  plane.origin =
      (scale * (rise_x * (128 - v[0].x_fx) + rise_y * (128 - v[0].y_fx) + a * v[0].z_fx)).value;
  return finished(plane, view);
}

/// x, y, z, w times the least power of two that makes them whole. A vertex may be scaled on its
/// own: the plane a x + b y + c w = z stays the same.
std::array<Int128, 4> whole(const glm::vec4& p) {
  int lowest = 1000;
  for (int i = 0; i < 4; ++i) {
    if (p[i] == 0.0f) continue;
    int exponent = 0;
    const auto mantissa =
        static_cast<std::uint32_t>(std::ldexp(std::frexp(std::abs(p[i]), &exponent), 24));
    lowest = std::min(lowest, exponent - 24 + std::countr_zero(mantissa));
  }
  std::array<Int128, 4> out{};
  for (int i = 0; i < 4; ++i) {
    const double scaled = std::ldexp(static_cast<double>(p[i]), -lowest);
    if (std::abs(scaled) > 0x1p60)
      throw std::overflow_error("a vertex spans too many powers of two");
    out[static_cast<std::size_t>(i)] = static_cast<Int128>(scaled);
  }
  return out;
}

using Column = std::array<Int128, 3>;

Checked determinant(const Column& a, const Column& b, const Column& c) {
  const auto minor = [&](std::size_t i, std::size_t j) {
    return Checked(b[i]) * c[j] - Checked(b[j]) * c[i];
  };
  return Checked(a[0]) * minor(1, 2) - Checked(a[1]) * minor(0, 2) + Checked(a[2]) * minor(0, 1);
}

std::int64_t floor_quotient(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

bool lies_before(const SnappedVertex& a, const SnappedVertex& b) {
  return std::tuple(a.x_fx, a.y_fx, a.z_fx) < std::tuple(b.x_fx, b.y_fx, b.z_fx);
}

int clamped(std::int64_t value, int high) {
  return static_cast<int>(std::clamp<std::int64_t>(value, 0, high));
}

}  // namespace

Piece::Piece(const std::array<SnappedVertex, 3>& vertices, const View& view)
    : vertices_(vertices), plane_(snapped_plane(vertices, view)) {
  const auto [low, high] = std::minmax({vertices[0].y_fx, vertices[1].y_fx, vertices[2].y_fx});
  rows_ = {clamped(floor_quotient(low + 127, 256), view.height),
           clamped(floor_quotient(high - 128, 256) + 1, view.height)};
}

Span Piece::covered(int y) const {
  const std::int64_t cy = std::int64_t{y} * 256 + 128;
  std::int64_t first = 0, last = kMaxTargetSize;
  for (std::size_t k = 0; k < 3; ++k) {
    const SnappedVertex &from = vertices_[k], &to = vertices_[(k + 1) % 3];
    const std::int64_t dx = to.x_fx - from.x_fx, dy = to.y_fx - from.y_fx;
    const bool owned = dy < 0 || (dy == 0 && dx > 0);
    // Inside where dx (cy - from.y) - dy (cx - from.x) is positive, or zero on an owned edge, with
    // cx = 256 x + 128.
    const std::int64_t rest = dx * (cy - from.y_fx) - dy * (128 - from.x_fx) - (owned ? 0 : 1);
    if (dy > 0) last = std::min(last, floor_quotient(rest, dy * 256));
    if (dy < 0) first = std::max(first, -floor_quotient(rest, -dy * 256));
    if (dy == 0 && rest < 0) return {};
  }
  return {clamped(first, kMaxTargetSize), clamped(last + 1, kMaxTargetSize)};
}

std::vector<Piece> snapped_pieces(const std::array<glm::vec4, 3>& clip, const View& view) {
  constexpr double kGuardPixels = 16384.0;
  const ClipVolume volume{2.0 * kGuardPixels / view.width, 2.0 * kGuardPixels / view.height,
                          !view.clamp};
  std::vector<SnappedVertex> corners;
  if (volume.contains(clip[0]) && volume.contains(clip[1]) && volume.contains(clip[2])) {
    for (const glm::vec4& p : clip) corners.push_back(snapped(glm::dvec4(p), view));
  } else {
    const ClippedPolygon polygon = clip_triangle(clip, volume);
    for (int i = 0; i < polygon.count; ++i)
      corners.push_back(snapped(polygon.vertices[static_cast<std::size_t>(i)].position, view));
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), lies_before),
                corners.end());
  }
  std::vector<Piece> pieces;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    std::array<SnappedVertex, 3> v{corners[0], corners[i - 1], corners[i]};
    if (area(v) == 0) continue;
    if (area(v) < 0) std::swap(v[1], v[2]);
    pieces.emplace_back(v, view);
  }
  return pieces;
}

std::optional<Plane> unrounded_plane(const std::array<glm::vec4, 3>& clip, const View& view) {
  std::array<Column, 4> columns{};
  for (std::size_t v = 0; v < 3; ++v) {
    const std::array<Int128, 4> p = whole(clip[v]);
    for (std::size_t i = 0; i < 4; ++i) columns[i][v] = p[i];
  }
  const auto& [x, y, z, w] = columns;
  const Checked d = determinant(x, y, w);
  if (d.value == 0) return std::nullopt;
  const Int128 sign = d.value < 0 ? -1 : 1;
  // z / w = (a X + b Y + c) / d with X = (2 px + 1 - width) / width, and depth = (z / w + 1) / 2.
  const Checked a = determinant(z, y, w) * sign, b = determinant(x, z, w) * sign;
  const Checked c = determinant(x, y, z) * sign;
  const Int128 both = std::max(view.width, view.height);
  if (both % view.width != 0 || both % view.height != 0)
    throw std::invalid_argument("of a target's width and height one divides the other");
  const Checked full = Int128{kQuarters} * max_depth(view.format);
  const Checked a_px = full * a * (both / view.width), b_px = full * b * (both / view.height);
  Plane plane;
  plane.one = (Checked(Int128{2 * kQuarters}) * d * sign * both).value;
  plane.step_x = (a_px * 2).value;
  plane.step_y = (b_px * 2).value;
  plane.origin =
      (a_px * (1 - view.width) + b_px * (1 - view.height) + full * (c + d * sign) * both).value;
  return finished(plane, view);
}

void Errors::add(std::uint32_t stored, Int128 exact, const Plane& plane) {
  const Int128 value = exact < plane.low ? plane.low : exact > plane.high ? plane.high : exact;
  const Int128 difference = static_cast<Int128>(stored) * plane.one - value;
  const Int128 size = difference < 0 ? -difference : difference;
  const double error = static_cast<double>(size) / static_cast<double>(plane.one);
  ++pixels;
  beyond_one += size > plane.one;
  largest = std::max(largest, error);
  if (value == exact)
    unclamped_sum += error;
  else
    ++clamped;
}

void Errors::add(const Errors& other) {
  pixels += other.pixels;
  beyond_one += other.beyond_one;
  clamped += other.clamped;
  largest = std::max(largest, other.largest);
  unclamped_sum += other.unclamped_sum;
}

}  // namespace gnomon::exact_depth
