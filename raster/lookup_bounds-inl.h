// Vector kernel: bounds of what a triangle's depth lookups meet, the four rows of the lookup's
// matrix a lane each.
//
// A fragment's position is a sum of corners (a triangle's, or those of a box round some triangles),
// the weights not negative and of sum 1 up to rounding, so its s, t, r and q lie between those of
// the corners, and s / q, t / q and r / q between the corners' quotients (q positive). Rounding,
// with u = 2^-24 and A the sum of a row's |m| |v|: of weights u A, of the position 3.1 u A, of its
// row 4.1 u A, of a corner's row 4.1 u A; 2^-19 A is more than twice that. A quotient rounds by u
// and a product by u of itself; 16 u are more. Small constants cover what underflows. Read once for
// each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_LOOKUP_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_LOOKUP_BOUNDS_INL_H
#undef GNOMON_RASTER_LOOKUP_BOUNDS_INL_H
#else
#define GNOMON_RASTER_LOOKUP_BOUNDS_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using DRow = hn::Full128<float>;
using VRow = hn::Vec<DRow>;

/// Texels of a map, those outside as one before the first or after the last, and references.
struct LookupBox {
  std::int32_t first[4], last[4];
  float least[4], greatest[4];
};

HWY_INLINE VRow rows_of(VRow c0, VRow c1, VRow c2, VRow c3, VRow v) {
  return hn::Add(hn::Add(hn::Mul(c0, hn::Broadcast<0>(v)), hn::Mul(c1, hn::Broadcast<1>(v))),
                 hn::Add(hn::Mul(c2, hn::Broadcast<2>(v)), hn::Mul(c3, hn::Broadcast<3>(v))));
}

/// False if nothing is known: a corner lies behind the lookup's eye, or numbers are too large.
/// There are corners.
HWY_INLINE bool bound_lookups(const LookupTerms& lookup, const glm::vec4* positions,
                              const std::uint32_t* index, int count, LookupBox& box) {
  const DRow d;
  const hn::RebindToSigned<DRow> whole_d;
  const auto& m = lookup.map_from_position;
  const VRow c0 = hn::LoadU(d, m[0]), c1 = hn::LoadU(d, m[1]), c2 = hn::LoadU(d, m[2]),
             c3 = hn::LoadU(d, m[3]), zero = hn::Zero(d);
  const VRow huge = hn::Set(d, 1e30f);
  VRow largest = zero, least_q = huge, low = huge, high = hn::Neg(huge);
  for (int k = 0; k < count; ++k) {
    const VRow corner = hn::LoadU(d, &positions[index[k]].x);
    const VRow rows = rows_of(c0, c1, c2, c3, corner), q = hn::Broadcast<3>(rows);
    const VRow quotient = hn::Div(rows, q);
    largest = hn::Max(largest, hn::Abs(corner));
    least_q = hn::Min(least_q, q);
    low = hn::Min(low, quotient);
    high = hn::Max(high, quotient);
  }
  const VRow sizes = rows_of(hn::Abs(c0), hn::Abs(c1), hn::Abs(c2), hn::Abs(c3), largest);
  const VRow margin = hn::Add(hn::Mul(sizes, hn::Set(d, 0x1p-19f)), hn::Set(d, 1e-30f));
  const VRow margin_q = hn::Broadcast<3>(margin);
  least_q = hn::Sub(least_q, margin_q);
  const auto moderate = hn::Lt(hn::Max(sizes, largest), huge);
  if (!hn::AllTrue(d, hn::And(moderate, hn::Gt(least_q, zero)))) return false;
  const VRow size = hn::Max(hn::Abs(low), hn::Abs(high));
  const VRow slack = hn::Add(hn::Div(hn::Add(margin, hn::Mul(size, margin_q)), least_q),
                             hn::Add(hn::Mul(size, hn::Set(d, 0x1p-20f)), hn::Set(d, 1e-30f)));
  low = hn::Sub(low, slack);
  high = hn::Add(high, slack);
  hn::StoreU(low, d, box.least);
  hn::StoreU(high, d, box.greatest);
  const float texels[4] = {static_cast<float>(lookup.width), static_cast<float>(lookup.height),
                           1.0f, 1.0f};
  const VRow end = hn::LoadU(d, texels), before = hn::Set(d, -1.0f);
  const auto texel = [&](VRow v) HWY_ATTR {
    const VRow near = hn::Min(hn::Max(hn::Mul(v, end), before), end);
    return hn::ConvertTo(whole_d, hn::Floor(near));
  };
  // Linear filters read the texels next to it.
  const auto next = hn::Set(whole_d, lookup.linear ? 1 : 0);
  hn::StoreU(hn::Sub(texel(low), next), whole_d, box.first);
  hn::StoreU(hn::Add(texel(high), next), whole_d, box.last);
  return true;
}

/// The blocks of a row or column of `size` texels that hold those from `first` to `last`; those
/// outside are the edge's.
struct BlockInterval {
  int first, last;
};

HWY_INLINE BlockInterval blocks_of_texels(int first, int last, int size) {
  return {HWY_MIN(HWY_MAX(first, 0), size - 1) / 8, HWY_MIN(HWY_MAX(last, 0), size - 1) / 8};
}

/// Some reference between r0 and r1 and some texel between t0 and t1 can be related so.
HWY_INLINE bool can_hold(CompareFunc func, double r0, double r1, double t0, double t1) {
  // A function's number is the sum of 1 for less, 2 for equal and 4 for greater.
  const int related = (r0 < t1 ? 1 : 0) | (r0 <= t1 && r1 >= t0 ? 2 : 0) | (r1 > t0 ? 4 : 0);
  return (related & static_cast<int>(func)) != 0;
}

bool lookup_fails(const LookupBounds& bounds, const glm::vec4* positions,
                  const std::uint32_t* index, int count) noexcept {
  constexpr int kMostBlocks = 256;
  const LookupTerms& lookup = *bounds.lookup;
  LookupBox box;
  if (!bound_lookups(lookup, positions, index, count, box)) return false;
  const BlockInterval x = blocks_of_texels(box.first[0], box.last[0], lookup.width);
  const BlockInterval y = blocks_of_texels(box.first[1], box.last[1], lookup.height);
  if ((x.last - x.first + 1) * (y.last - y.first + 1) > kMostBlocks) return false;
  std::uint32_t least = ~0u, greatest = 0;
  for (int by = y.first; by <= y.last; ++by)
    for (int bx = x.first; bx <= x.last; ++bx) {
      const LookupRange& range = bounds.blocks[by * bounds.blocks_x + bx];
      least = HWY_MIN(least, range.least);
      greatest = HWY_MAX(greatest, range.greatest);
    }
  const double one = static_cast<double>(lookup.units) - 1.0;
  const double r0 = one * HWY_MIN(HWY_MAX(box.least[2], 0.0f), 1.0f),
               r1 = one * HWY_MIN(HWY_MAX(box.greatest[2], 0.0f), 1.0f);
  if (can_hold(lookup.func, r0, r1, least, greatest)) return false;
  const bool outside = box.first[0] < 0 || box.first[1] < 0 || box.last[0] >= lookup.width ||
                       box.last[1] >= lookup.height;
  const double border = one * lookup.border;
  return !lookup.has_border || !outside || !can_hold(lookup.func, r0, r1, border, border);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
