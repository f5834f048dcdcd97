// The 64 pixels of a block as lanes of vectors: tags, masks and steps that the vector kernels
// share. Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_LANES_INL_H
#undef GNOMON_RASTER_LANES_INL_H
#else
#define GNOMON_RASTER_LANES_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kWidth = 8, kPixels = 64;

using DI32 = hn::CappedTag<std::int32_t, kPixels>;
using DU32 = hn::CappedTag<std::uint32_t, kPixels>;
using DU8 = hn::CappedTag<std::uint8_t, kPixels>;
using VI32 = hn::Vec<DI32>;
using VU32 = hn::Vec<DU32>;
using VU8 = hn::Vec<DU8>;
using DF32 = hn::CappedTag<float, kPixels>;
using VF32 = hn::Vec<DF32>;

HWY_INLINE VF32 set(float value) { return hn::Set(DF32(), value); }

/// The pixels of lanes [first, first + Lanes) as a vector mask.
template <class D>
HWY_INLINE hn::Mask<D> lanes_of(D d, PixelMask mask, std::size_t first) {
  const PixelMask bits = mask >> first;
  return hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&bits));
}

/// A vector mask as the pixels of lanes [first, first + Lanes).
template <class D>
HWY_INLINE PixelMask pixels_of(D d, hn::Mask<D> mask, std::size_t first) {
  PixelMask bits = 0;
  hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
  if (hn::Lanes(d) < kPixels) bits &= (PixelMask{1} << (hn::Lanes(d) % kPixels)) - 1;
  return bits << first;
}

/// The vectors of a block with the rows that some pixels lie in: first lanes first <= i < end, a
/// vector apart.
struct VectorRange {
  std::size_t first, end;
};

/// Rows of 8 lanes, or more where a vector has more.
template <class D>
constexpr std::size_t rows_at_once(D d) {
  return hn::MaxLanes(d) > kWidth ? hn::MaxLanes(d) / kWidth : 1;
}

/// Precondition: there are some.
template <class D>
HWY_INLINE VectorRange vectors_of(D d, PixelMask pixels) {
  const auto first = static_cast<std::size_t>(__builtin_ctzll(pixels));
  const auto end = kPixels - static_cast<std::size_t>(__builtin_clzll(pixels));
  return {first & ~(rows_at_once(d) * kWidth - 1), end};
}

/// x * step_x + y * step_y for the pixels of a vector whose first lane is pixel (0, 0); sums are
/// modulo 2^32.
HWY_INLINE VU32 lane_steps(DU32 d, std::uint32_t step_x, std::uint32_t step_y) {
  const VU32 lane = hn::Iota(d, 0);
  const VU32 x = hn::And(lane, hn::Set(d, kWidth - 1)), y = hn::ShiftRight<3>(lane);
  return hn::Add(hn::Mul(x, hn::Set(d, step_x)), hn::Mul(y, hn::Set(d, step_y)));
}

/// Sums base + x * step_x + y * step_y over an 8x8 grid, a vector after the other: what next(i)
/// gives is for pixels [i, i + Lanes), where i is the first one that was asked for and then goes up
/// a vector at a time. `lanes` is lane_steps of the same steps.
class RunningSums {
 public:
  HWY_INLINE RunningSums(VU32 lanes, std::uint32_t base, std::uint32_t step_x, std::uint32_t step_y,
                         std::size_t first_row = 0)
      : left_(
            hn::Add(hn::Set(DU32(), base + static_cast<std::uint32_t>(first_row) * step_y), lanes)),
        to_right_(hn::Set(DU32(), static_cast<std::uint32_t>(hn::Lanes(DU32())) * step_x)),
        up_(hn::Set(DU32(), static_cast<std::uint32_t>(rows_at_once(DU32())) * step_y)) {}

  HWY_INLINE VU32 next(std::size_t i) {
    const VU32 sums = i % kWidth == 0 ? left_ : hn::Add(left_, to_right_);
    if ((i + hn::Lanes(DU32())) % kWidth == 0) left_ = hn::Add(left_, up_);
    return sums;
  }

 private:
  VU32 left_, to_right_, up_;
};

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
