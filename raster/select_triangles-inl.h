// Vector kernel: the choice of raster/select_triangles.cpp, a triangle a lane. Areas in double:
// products of 26 bits and their difference are exact.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_SELECT_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_SELECT_TRIANGLES_INL_H
#undef GNOMON_RASTER_SELECT_TRIANGLES_INL_H
#else
#define GNOMON_RASTER_SELECT_TRIANGLES_INL_H
#endif

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

/// Twice the signed areas, two vectors of double after one another in `out`; returns their signs:
/// -1, 0 or 1.
HWY_INLINE VI32 signed_areas(const CornerLanes& c, double* out) {
  const DI32 d;
  const hn::Half<DI32> half_d;
  const hn::RepartitionToWide<hn::RebindToFloat<DI32>> wide_d;
  const hn::Rebind<float, decltype(half_d)> single_d;
  const VI32 dx1 = hn::Sub(c.x[1], c.x[0]), dy1 = hn::Sub(c.y[1], c.y[0]);
  const VI32 dx2 = hn::Sub(c.x[2], c.x[0]), dy2 = hn::Sub(c.y[2], c.y[0]);
  const auto low = [&](VI32 v) HWY_ATTR { return hn::PromoteTo(wide_d, hn::LowerHalf(half_d, v)); };
  const auto high = [&](VI32 v)
                        HWY_ATTR { return hn::PromoteTo(wide_d, hn::UpperHalf(half_d, v)); };
  const auto low_area = hn::Sub(hn::Mul(low(dx1), low(dy2)), hn::Mul(low(dx2), low(dy1)));
  const auto high_area = hn::Sub(hn::Mul(high(dx1), high(dy2)), hn::Mul(high(dx2), high(dy1)));
  hn::StoreU(low_area, wide_d, out);
  hn::StoreU(high_area, wide_d, out + hn::Lanes(wide_d));
  // Whole numbers, so rounding to float32 keeps sign and zero.
  const hn::RebindToFloat<DI32> float_d;
  const auto area =
      hn::Combine(float_d, hn::DemoteTo(single_d, high_area), hn::DemoteTo(single_d, low_area));
  const auto zero = hn::Zero(float_d);
  return hn::Sub(hn::VecFromMask(d, hn::RebindMask(d, hn::Lt(area, zero))),
                 hn::VecFromMask(d, hn::RebindMask(d, hn::Gt(area, zero))));
}

/// The lanes whose triangle, of this sign, covers the centre of one of the 2x2 pixels from (x0, y0)
/// on; of those pixels the ones below (x1, y1) count.
HWY_INLINE hn::Mask<DI32> holds_a_center(const CornerLanes& c, VI32 sign, VI32 x0, VI32 y0, VI32 x1,
                                         VI32 y1) {
  const DI32 d;
  const VI32 zero = hn::Zero(d), one = hn::Set(d, 1);
  const auto clockwise = hn::Lt(sign, zero);
  const VI32 center_x = hn::Add(hn::ShiftLeft<8>(x0), hn::Set(d, 128));
  const VI32 center_y = hn::Add(hn::ShiftLeft<8>(y0), hn::Set(d, 128));
  // Edge values less their bias at the four centres, or-ed: the sign bit tells who is outside.
  VI32 first = zero, right = zero, above = zero, diagonal = zero;
  for (int k = 0; k < 3; ++k) {
    const VI32 from_x = c.x[k], from_y = c.y[k];
    const VI32 to_x = c.x[(k + 1) % 3], to_y = c.y[(k + 1) % 3];
    VI32 a = hn::Sub(from_y, to_y), b = hn::Sub(to_x, from_x);
    a = hn::IfThenElse(clockwise, hn::Neg(a), a);
    b = hn::IfThenElse(clockwise, hn::Neg(b), b);
    const auto unbiased = hn::Or(hn::Gt(a, zero), hn::And(hn::Eq(a, zero), hn::Gt(b, zero)));
    const VI32 value = hn::Sub(
        hn::Add(hn::Mul(a, hn::Sub(center_x, from_x)), hn::Mul(b, hn::Sub(center_y, from_y))),
        hn::IfThenZeroElse(unbiased, one));
    const VI32 step_x = hn::ShiftLeft<8>(a), step_y = hn::ShiftLeft<8>(b);
    first = hn::Or(first, value);
    right = hn::Or(right, hn::Add(value, step_x));
    above = hn::Or(above, hn::Add(value, step_y));
    diagonal = hn::Or(diagonal, hn::Add(value, hn::Add(step_x, step_y)));
  }
  const auto wide = hn::Gt(x1, hn::Add(x0, one)), tall = hn::Gt(y1, hn::Add(y0, one));
  const auto in = [&](VI32 values) HWY_ATTR { return hn::Not(hn::Lt(values, zero)); };
  return hn::Or(hn::Or(in(first), hn::And(wide, in(right))),
                hn::And(tall, hn::Or(in(above), hn::And(wide, in(diagonal)))));
}

/// Looks at the triangles of a vector of lanes, the first of which is number i of the batch.
HWY_INLINE void select_lanes(const TriangleSelector& s, const std::uint32_t* indices, std::size_t i,
                             TriangleBatch& out) {
  const DI32 d;
  hn::Vec<DU32> corner[3];
  hn::LoadInterleaved3(DU32(), indices, corner[0], corner[1], corner[2]);
  CornerLanes c;
  for (int k = 0; k < 3; ++k) {
    const VI32 index = hn::BitCast(d, corner[k]);
    c.x[k] = hn::GatherIndex(d, s.x_fx, index);
    c.y[k] = hn::GatherIndex(d, s.y_fx, index);
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
  if (!hn::AllFalse(d, tiny))
    kept = hn::AndNot(hn::AndNot(holds_a_center(c, sign, x0, y0, x1, y1), tiny), kept);
  out.kept |= pixels_of(d, kept, i);
  out.clockwise |= pixels_of(d, hn::And(kept, clockwise), i);
  out.small |= pixels_of(d, hn::And(kept, small), i);
  hn::StoreU(x0, d, out.x0 + i);
  hn::StoreU(y0, d, out.y0 + i);
  hn::StoreU(x1, d, out.x1 + i);
  hn::StoreU(y1, d, out.y1 + i);
}

void select_triangles(const TriangleSelector& selector, const std::uint32_t* indices,
                      std::size_t count, TriangleBatch& out) noexcept {
  static_assert(kTriangleBatch == kPixels);
  const std::size_t lanes = hn::Lanes(DI32());
  out.clipped = out.kept = out.clockwise = out.small = 0;
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
