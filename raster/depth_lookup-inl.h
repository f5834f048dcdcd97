// Vector kernel: the lookup of raster/depth_lookup.cpp, a position a lane. Its operations in its
// order up to the texel; a comparison with a texel, which it does in double, is done in integers.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_DEPTH_LOOKUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_DEPTH_LOOKUP_INL_H
#undef GNOMON_RASTER_DEPTH_LOOKUP_INL_H
#else
#define GNOMON_RASTER_DEPTH_LOOKUP_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

/// A NaN becomes 0.
HWY_INLINE VF32 number_or_zero(VF32 value) {
  return hn::IfThenElseZero(hn::Eq(value, value), value);
}
HWY_INLINE VF32 clamped(VF32 value, float least, float greatest) {
  return hn::Min(hn::Max(value, set(least)), set(greatest));
}

/// What texels are compared with.
struct LookupReference {
  /// r / q in [0, 1].
  VF32 share;
  /// The same in depth units, rounded down and up: a whole number is less than, or greater than,
  /// the one exactly if it is so of the other.
  VI32 floor, ceil;
};

HWY_INLINE LookupReference reference_of(VF32 share, float units) {
  const DF32 d;
  const DI32 whole_d;
  // Depth units are share * (units - 1) = whole + (rest - share). The product and the rest are
  // exact, because units is a power of two, and rest - share is in (-1, 1), or -1 for a share of 1.
  const VF32 product = hn::Mul(share, set(units));
  const VI32 whole = hn::ConvertTo(whole_d, product);
  const VF32 rest = hn::Sub(product, hn::ConvertTo(d, whole));
  const auto minus_one_if = [&](hn::Mask<DF32> mask) HWY_ATTR {
    return hn::VecFromMask(whole_d, hn::RebindMask(whole_d, mask));
  };
  return {share, hn::Add(whole, minus_one_if(hn::Lt(rest, share))),
          hn::Add(hn::Sub(whole, minus_one_if(hn::Gt(rest, share))),
                  minus_one_if(hn::Ge(share, set(1.0f))))};
}

/// "reference func texel", given the same as reals (`share` and `border`) and in units.
HWY_INLINE hn::Mask<DI32> holds(CompareFunc func, VI32 floor, VI32 ceil, VI32 texel) {
  switch (func) {
    case CompareFunc::less:
      return hn::Lt(floor, texel);
    case CompareFunc::equal:
      return hn::And(hn::Eq(floor, texel), hn::Eq(ceil, texel));
    case CompareFunc::less_equal:
      return hn::Not(hn::Gt(ceil, texel));
    case CompareFunc::greater:
      return hn::Gt(ceil, texel);
    case CompareFunc::not_equal:
      return hn::Not(hn::And(hn::Eq(floor, texel), hn::Eq(ceil, texel)));
    case CompareFunc::greater_equal:
      return hn::Not(hn::Lt(floor, texel));
    case CompareFunc::always:
      return hn::Eq(floor, floor);
    case CompareFunc::never:
      break;
  }
  return hn::Ne(floor, floor);
}

/// The texels at (x, y), which lie inside the map.
HWY_INLINE VI32 texels_at(const LookupTerms& lookup, VI32 x, VI32 y) {
  const DI32 d;
  const VI32 low = hn::Set(d, 7), high = hn::Set(d, 0x38);
  const VI32 in_row = hn::Add(hn::And(x, low), hn::ShiftLeft<3>(hn::And(x, high)));
  const VI32 row = hn::Add(hn::ShiftLeft<3>(hn::And(y, low)), hn::ShiftLeft<6>(hn::And(y, high)));
  const VI32 tile =
      hn::Add(hn::Mul(hn::ShiftRight<6>(y), hn::Set(d, lookup.tiles_x)), hn::ShiftRight<6>(x));
  return hn::GatherIndex(d, reinterpret_cast<const std::int32_t*>(lookup.texels),
                         hn::Add(hn::ShiftLeft<12>(tile), hn::Add(in_row, row)));
}

/// 1 or 0 for texels (x, y), which may lie outside.
HWY_INLINE VF32 passes(const LookupTerms& lookup, VI32 x, VI32 y, const LookupReference& ref) {
  const DI32 d;
  const VI32 zero = hn::Zero(d);
  const VI32 inner_x = hn::Min(hn::Max(x, zero), hn::Set(d, lookup.width - 1));
  const VI32 inner_y = hn::Min(hn::Max(y, zero), hn::Set(d, lookup.height - 1));
  auto passed = holds(lookup.func, ref.floor, ref.ceil, texels_at(lookup, inner_x, inner_y));
  if (lookup.has_border) {
    // Both are the same number of units a share, so the shares compare as the units do.
    const VF32 border = set(lookup.border);
    const VI32 side = hn::Sub(hn::VecFromMask(d, hn::RebindMask(d, hn::Lt(ref.share, border))),
                              hn::VecFromMask(d, hn::RebindMask(d, hn::Gt(ref.share, border))));
    const VI32 inside = hn::VecFromMask(d, hn::And(hn::Eq(x, inner_x), hn::Eq(y, inner_y)));
    const VI32 of_border = hn::VecFromMask(d, holds(lookup.func, side, side, zero));
    passed = hn::MaskFromVec(hn::IfVecThenElse(inside, hn::VecFromMask(d, passed), of_border));
  }
  return hn::IfThenElseZero(hn::RebindMask(DF32(), passed), set(1.0f));
}

HWY_INLINE VF32 mixed(VF32 a, VF32 b, VF32 t) {
  return hn::Add(hn::Mul(a, hn::Sub(set(1.0f), t)), hn::Mul(b, t));
}

/// Coordinates in texels, far enough inside an int's range for its neighbours.
HWY_INLINE VF32 texel_coordinate(VF32 coordinate, int size) {
  constexpr float kLimit = 1073741824.0f;
  return clamped(number_or_zero(hn::Mul(coordinate, set(static_cast<float>(size)))), -kLimit,
                 kLimit);
}

/// The shares of comparisons that hold at positions (x, y, z, w).
HWY_INLINE VF32 compare_depth(const LookupTerms& lookup, VF32 x, VF32 y, VF32 z, VF32 w) {
  const DI32 whole_d;
  const auto row = [&](std::size_t i) HWY_ATTR {
    const auto& m = lookup.map_from_position;
    return hn::Add(hn::Add(hn::Add(hn::Mul(set(m[0][i]), x), hn::Mul(set(m[1][i]), y)),
                           hn::Mul(set(m[2][i]), z)),
                   hn::Mul(set(m[3][i]), w));
  };
  const VF32 q = row(3);
  VF32 u = texel_coordinate(hn::Div(row(0), q), lookup.width);
  VF32 v = texel_coordinate(hn::Div(row(1), q), lookup.height);
  const VF32 share = clamped(number_or_zero(hn::Div(row(2), q)), 0.0f, 1.0f);
  const LookupReference ref = reference_of(share, lookup.units);
  if (!lookup.linear)
    return passes(lookup, hn::ConvertTo(whole_d, hn::Floor(u)),
                  hn::ConvertTo(whole_d, hn::Floor(v)), ref);
  u = hn::Sub(u, set(0.5f));
  v = hn::Sub(v, set(0.5f));
  const VF32 u0 = hn::Floor(u), v0 = hn::Floor(v);
  const VF32 right = hn::Sub(u, u0), up = hn::Sub(v, v0);
  const VI32 one = hn::Set(whole_d, 1);
  const VI32 x0 = hn::ConvertTo(whole_d, u0), y0 = hn::ConvertTo(whole_d, v0);
  const VI32 x1 = hn::Add(x0, one), y1 = hn::Add(y0, one);
  return mixed(mixed(passes(lookup, x0, y0, ref), passes(lookup, x1, y0, ref), right),
               mixed(passes(lookup, x0, y1, ref), passes(lookup, x1, y1, ref), right), up);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
