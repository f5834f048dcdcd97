// Vector kernel: the choice of raster/select_triangles.cpp, a triangle a lane. Areas in double:
// products of 26 bits and their difference are exact. Depth planes in double where all is below
// 2^53, so that quotients and their remainders are exact too.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_SELECT_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_SELECT_TRIANGLES_INL_H
#undef GNOMON_RASTER_SELECT_TRIANGLES_INL_H
#else
#define GNOMON_RASTER_SELECT_TRIANGLES_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

HWY_INLINE VI32 least(VI32 a, VI32 b, VI32 c) { return hn::Min(hn::Min(a, b), c); }
HWY_INLINE VI32 greatest(VI32 a, VI32 b, VI32 c) { return hn::Max(hn::Max(a, b), c); }

/// Snapped corners of as many triangles as there are lanes.
struct CornerLanes {
  VI32 x[3], y[3];
};

/// Half of a vector of 32-bit lanes as double or 64-bit integers.
using DI32Half = hn::Half<DI32>;
using DArea = hn::Rebind<double, DI32Half>;
using DDepth = hn::Rebind<std::int64_t, DI32Half>;
using VArea = hn::Vec<DArea>;

/// Half 0 is the lower one, half 1 the upper.
template <int kHalf>
HWY_INLINE hn::Vec<DI32Half> half_of(VI32 v) {
  if constexpr (kHalf == 0) return hn::LowerHalf(DI32Half(), v);
  return hn::UpperHalf(DI32Half(), v);
}
template <int kHalf>
HWY_INLINE VArea to_double(VI32 v) {
  return hn::PromoteTo(DArea(), half_of<kHalf>(v));
}

template <int kHalf>
HWY_INLINE VArea signed_area(VI32 dx1, VI32 dy1, VI32 dx2, VI32 dy2) {
  return hn::Sub(hn::Mul(to_double<kHalf>(dx1), to_double<kHalf>(dy2)),
                 hn::Mul(to_double<kHalf>(dx2), to_double<kHalf>(dy1)));
}

/// Twice the signed areas, two vectors of double after one another in `out`; returns their signs:
/// -1, 0 or 1.
HWY_INLINE VI32 signed_areas(const CornerLanes& c, double* out) {
  const DI32 d;
  const DArea wide_d;
  const hn::Rebind<float, DI32Half> single_d;
  const VI32 dx1 = hn::Sub(c.x[1], c.x[0]), dy1 = hn::Sub(c.y[1], c.y[0]);
  const VI32 dx2 = hn::Sub(c.x[2], c.x[0]), dy2 = hn::Sub(c.y[2], c.y[0]);
  const VArea low = signed_area<0>(dx1, dy1, dx2, dy2), high = signed_area<1>(dx1, dy1, dx2, dy2);
  hn::StoreU(low, wide_d, out);
  hn::StoreU(high, wide_d, out + hn::Lanes(wide_d));
  // Whole numbers, so rounding to float32 keeps sign and zero.
  const hn::RebindToFloat<DI32> float_d;
  const auto area = hn::Combine(float_d, hn::DemoteTo(single_d, high), hn::DemoteTo(single_d, low));
  const auto zero = hn::Zero(float_d);
  return hn::Sub(hn::VecFromMask(d, hn::RebindMask(d, hn::Lt(area, zero))),
                 hn::VecFromMask(d, hn::RebindMask(d, hn::Gt(area, zero))));
}

/// A whole number between -2^51 and 2^51 to double and back: beside 2^52 the last bit of a double
/// is worth 1.
HWY_INLINE VArea to_double(hn::Vec<DDepth> whole) {
  const VArea magic = hn::Set(DArea(), 0x1.8p52);
  return hn::Sub(hn::BitCast(DArea(), hn::Add(whole, hn::BitCast(DDepth(), magic))), magic);
}
HWY_INLINE hn::Vec<DDepth> to_integer(VArea whole) {
  const VArea magic = hn::Set(DArea(), 0x1.8p52);
  return hn::Sub(hn::BitCast(DDepth(), hn::Add(whole, magic)), hn::BitCast(DDepth(), magic));
}

/// numerator / denominator to the nearest whole number, a half upwards (raster/wide.h); both are
/// whole and below 2^51, the denominator positive.
HWY_INLINE VArea nearest_quotient(VArea numerator, VArea denominator) {
  const VArea one = hn::Set(DArea(), 1.0);
  const VArea quotient = hn::Round(hn::Div(numerator, denominator));
  const VArea remainder = hn::Sub(numerator, hn::Mul(quotient, denominator));
  const VArea twice = hn::Add(remainder, remainder);
  const VArea up = hn::IfThenElseZero(hn::Ge(twice, denominator), one);
  const VArea down = hn::IfThenElseZero(hn::Lt(twice, hn::Neg(denominator)), one);
  return hn::Sub(hn::Add(quotient, up), down);
}

/// Depth planes of the lanes of one half, which start at number i of the batch. Returns the lanes
/// where they are right, if the triangles are small.
template <int kHalf>
HWY_INLINE TriangleMask find_planes(const TriangleSelector& s, const CornerLanes& c,
                                    const VI32 (&index)[3], VI32 x0, VI32 y0, std::size_t i,
                                    TriangleBatch& out) {
  const DArea d;
  const DDepth depth_d;
  const DI32 narrow_d;
  const auto depth = [&](VI32 of) HWY_ATTR {
    return hn::GatherIndex(depth_d, s.z_fx, hn::PromoteTo(depth_d, half_of<kHalf>(of)));
  };
  const auto z0 = depth(index[0]), z1 = depth(index[1]), z2 = depth(index[2]);
  const VArea dz1 = to_double(hn::Sub(z1, z0)), dz2 = to_double(hn::Sub(z2, z0));
  const auto shallow = [&](hn::Vec<DDepth> dz) HWY_ATTR {
    return hn::And(hn::Lt(dz, hn::Set(depth_d, std::int64_t{1} << 36)),
                   hn::Gt(dz, hn::Set(depth_d, -(std::int64_t{1} << 36))));
  };
  const auto side = [&](const VI32(&v)[3], int k)
                        HWY_ATTR { return to_double<kHalf>(hn::Sub(v[k], v[0])); };
  const VArea dx1 = side(c.x, 1), dx2 = side(c.x, 2), dy1 = side(c.y, 1), dy2 = side(c.y, 2);
  const VArea signed_area = hn::LoadU(d, out.area + i), area = hn::Abs(signed_area);
  // Slopes times the positive area: clockwise corners change the sign of both.
  const auto clockwise = hn::Lt(signed_area, hn::Zero(d));
  const auto oriented = [&](VArea v) HWY_ATTR { return hn::IfThenElse(clockwise, hn::Neg(v), v); };
  const VArea slope_x = oriented(hn::Sub(hn::Mul(dz1, dy2), hn::Mul(dz2, dy1)));
  const VArea slope_y = oriented(hn::Sub(hn::Mul(dx1, dz2), hn::Mul(dx2, dz1)));
  // From the first vertex to the first pixel of the box's tile.
  constexpr int kTileMask = ~63;
  const auto to_tile = [&](VI32 pixel, VI32 vertex) HWY_ATTR {
    const VI32 first = hn::And(pixel, hn::Set(narrow_d, kTileMask));
    return to_double<kHalf>(
        hn::Sub(hn::Add(hn::ShiftLeft<8>(first), hn::Set(narrow_d, 128)), vertex));
  };
  const VArea along_x = hn::Mul(slope_x, to_tile(x0, c.x[0]));
  const VArea along_y = hn::Mul(slope_y, to_tile(y0, c.y[0]));
  const VArea subpixels = hn::Set(d, 256.0);
  const VArea rise_x = hn::Mul(slope_x, subpixels), rise_y = hn::Mul(slope_y, subpixels);
  const VArea limit = hn::Set(d, 0x1p49);
  const auto small_numbers =
      hn::And(hn::And(hn::Lt(hn::Abs(rise_x), limit), hn::Lt(hn::Abs(rise_y), limit)),
              hn::And(hn::Lt(hn::Abs(along_x), limit), hn::Lt(hn::Abs(along_y), limit)));
  hn::StoreU(to_integer(nearest_quotient(rise_x, area)), depth_d, out.step_x + i);
  hn::StoreU(to_integer(nearest_quotient(rise_y, area)), depth_d, out.step_y + i);
  hn::StoreU(hn::Add(z0, to_integer(nearest_quotient(hn::Add(along_x, along_y), area))), depth_d,
             out.base + i);
  return pixels_of(d, small_numbers, i) &
         pixels_of(depth_d, hn::And(shallow(hn::Sub(z1, z0)), shallow(hn::Sub(z2, z0))), i);
}

/// TinyPixels of triangles of this sign, the pixels from (x0, y0) on and below (x1, y1).
HWY_INLINE VI32 covered_pixels(const CornerLanes& c, VI32 sign, VI32 x0, VI32 y0, VI32 x1,
                               VI32 y1) {
  static_assert(kTinyBox == 4);
  const DI32 d;
  const VI32 zero = hn::Zero(d), one = hn::Set(d, 1);
  const auto clockwise = hn::Lt(sign, zero);
  const VI32 center_x = hn::Add(hn::ShiftLeft<8>(x0), hn::Set(d, 128));
  const VI32 center_y = hn::Add(hn::ShiftLeft<8>(y0), hn::Set(d, 128));
  // Edge values less their bias at a row's first centre, and their steps a pixel. Or-ed with each
  // other their sign bit tells who is outside.
  VI32 value[3], step_x[3], step_y[3];
  for (int k = 0; k < 3; ++k) {
    const VI32 from_x = c.x[k], from_y = c.y[k];
    const VI32 to_x = c.x[(k + 1) % 3], to_y = c.y[(k + 1) % 3];
    VI32 a = hn::Sub(from_y, to_y), b = hn::Sub(to_x, from_x);
    a = hn::IfThenElse(clockwise, hn::Neg(a), a);
    b = hn::IfThenElse(clockwise, hn::Neg(b), b);
    const auto unbiased = hn::Or(hn::Gt(a, zero), hn::And(hn::Eq(a, zero), hn::Gt(b, zero)));
    value[k] = hn::Sub(
        hn::Add(hn::Mul(a, hn::Sub(center_x, from_x)), hn::Mul(b, hn::Sub(center_y, from_y))),
        hn::IfThenZeroElse(unbiased, one));
    step_x[k] = hn::ShiftLeft<8>(a);
    step_y[k] = hn::ShiftLeft<8>(b);
  }
  // Negative from the box's end on.
  const VI32 last_x = hn::Sub(hn::Sub(x1, x0), one), last_y = hn::Sub(hn::Sub(y1, y0), one);
  const VI32 right[kTinyBox] = {last_x, hn::Sub(last_x, one), hn::Sub(last_x, hn::Set(d, 2)),
                                hn::Sub(last_x, hn::Set(d, 3))};
  VI32 left_rows = last_y, outside = zero;
  // From the last bit to the first would need the steps backwards; so a pixel's bit comes in at
  // the top and goes down.
  for (int y = 0; y < kTinyBox; ++y) {
    VI32 e0 = value[0], e1 = value[1], e2 = value[2];
    for (int x = 0; x < kTinyBox; ++x) {
      const VI32 any = hn::Or(hn::Or(hn::Or(e0, e1), hn::Or(e2, right[x])), left_rows);
      outside = hn::Or(hn::BitCast(d, hn::ShiftRight<1>(hn::BitCast(DU32(), outside))),
                       hn::And(any, hn::Set(d, std::numeric_limits<std::int32_t>::min())));
      if (x + 1 == kTinyBox) break;
      e0 = hn::Add(e0, step_x[0]);
      e1 = hn::Add(e1, step_x[1]);
      e2 = hn::Add(e2, step_x[2]);
    }
    left_rows = hn::Sub(left_rows, one);
    for (int k = 0; k < 3; ++k) value[k] = hn::Add(value[k], step_y[k]);
  }
  const auto pixels = hn::Not(hn::BitCast(DU32(), outside));
  return hn::BitCast(d, hn::ShiftRight<16>(pixels));
}

/// Looks at the triangles of a vector of lanes, the first of which is number i of the batch.
HWY_INLINE void select_lanes(const TriangleSelector& s, const std::uint32_t* indices, std::size_t i,
                             TriangleBatch& out) {
  const DI32 d;
  hn::Vec<DU32> corner[3];
  hn::LoadInterleaved3(DU32(), indices, corner[0], corner[1], corner[2]);
  CornerLanes c;
  VI32 index[3];
  for (int k = 0; k < 3; ++k) {
    index[k] = hn::BitCast(d, corner[k]);
    c.x[k] = hn::GatherIndex(d, s.x_fx, index[k]);
    c.y[k] = hn::GatherIndex(d, s.y_fx, index[k]);
  }
  const VI32 x_min = least(c.x[0], c.x[1], c.x[2]), x_max = greatest(c.x[0], c.x[1], c.x[2]);
  const VI32 y_min = least(c.y[0], c.y[1], c.y[2]), y_max = greatest(c.y[0], c.y[1], c.y[2]);
  const auto clipped = hn::Eq(x_min, hn::Set(d, kClipped));
  out.clipped |= pixels_of(d, clipped, i);

  const VI32 zero = hn::Zero(d), sign = signed_areas(c, out.area + i);
  const auto clockwise = hn::Lt(sign, zero), counterclockwise = hn::Gt(sign, zero);
  const VI32 to_first = hn::Set(d, 127), to_end = hn::Set(d, -128), one = hn::Set(d, 1);
  const VI32 x0 = hn::Max(hn::ShiftRight<8>(hn::Add(x_min, to_first)), hn::Set(d, s.box.x0));
  const VI32 y0 = hn::Max(hn::ShiftRight<8>(hn::Add(y_min, to_first)), hn::Set(d, s.box.y0));
  const VI32 x1 =
      hn::Min(hn::Add(hn::ShiftRight<8>(hn::Add(x_max, to_end)), one), hn::Set(d, s.box.x1));
  const VI32 y1 =
      hn::Min(hn::Add(hn::ShiftRight<8>(hn::Add(y_max, to_end)), one), hn::Set(d, s.box.y1));
  auto kept = hn::And(hn::And(hn::Lt(x0, x1), hn::Lt(y0, y1)),
                      hn::And(hn::Not(clipped), hn::Or(clockwise, counterclockwise)));
  if (!s.keeps_cw) kept = hn::AndNot(clockwise, kept);
  if (!s.keeps_ccw) kept = hn::AndNot(counterclockwise, kept);
  if (hn::AllFalse(d, kept)) return;

  const VI32 extent = hn::Set(d, kSmallExtent), tiny_box = hn::Set(d, kTinyBox + 1);
  const auto small =
      hn::And(hn::Lt(hn::Sub(x_max, x_min), extent), hn::Lt(hn::Sub(y_max, y_min), extent));
  const auto tiny = hn::And(hn::And(kept, small), hn::And(hn::Lt(hn::Sub(x1, x0), tiny_box),
                                                          hn::Lt(hn::Sub(y1, y0), tiny_box)));
  VI32 pixels = zero;
  if (!hn::AllFalse(d, tiny)) {
    pixels = hn::IfThenElseZero(tiny, covered_pixels(c, sign, x0, y0, x1, y1));
    kept = hn::AndNot(hn::And(tiny, hn::Eq(pixels, zero)), kept);
  }
  hn::StoreU(pixels, d, out.pixels + i);
  out.kept |= pixels_of(d, kept, i);
  out.clockwise |= pixels_of(d, hn::And(kept, clockwise), i);
  out.small |= pixels_of(d, hn::And(kept, small), i);
  hn::StoreU(x0, d, out.x0 + i);
  hn::StoreU(y0, d, out.y0 + i);
  hn::StoreU(x1, d, out.x1 + i);
  hn::StoreU(y1, d, out.y1 + i);
  if (!s.z_fx) return;
  const TriangleMask wanted = pixels_of(d, hn::And(kept, small), i);
  if (!wanted) return;
  const std::size_t upper = i + hn::Lanes(DArea());
  out.planes |= wanted & (find_planes<0>(s, c, index, x0, y0, i, out) |
                          find_planes<1>(s, c, index, x0, y0, upper, out));
}

void select_triangles(const TriangleSelector& selector, const std::uint32_t* indices,
                      std::size_t count, TriangleBatch& out) noexcept {
  static_assert(kTriangleBatch == kPixels);
  const std::size_t lanes = hn::Lanes(DI32());
  out.clipped = out.kept = out.clockwise = out.small = out.planes = 0;
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) select_lanes(selector, indices + 3 * i, i, out);
  if (i == count) return;
  // The rest, filled up with a triangle without area.
  std::uint32_t rest[3 * kPixels] = {};
  for (std::size_t k = 0; k < 3 * (count - i); ++k) rest[k] = indices[3 * i + k];
  select_lanes(selector, rest, i, out);
  const TriangleMask all = ~TriangleMask{0} >> (kTriangleBatch - count);
  out.clipped &= all;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
