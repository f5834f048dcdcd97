// Vector kernels: ranges of depths, of a block and against a triangle's.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_DEPTH_RANGES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_DEPTH_RANGES_INL_H
#undef GNOMON_RASTER_DEPTH_RANGES_INL_H
#else
#define GNOMON_RASTER_DEPTH_RANGES_INL_H
#endif

#include <hwy/highway.h>

#include "raster/cover-inl.h"
#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

void depth_range(const std::uint32_t* depth, std::uint32_t& least,
                 std::uint32_t& greatest) noexcept {
  const DI32 d;
  const auto* const stored = reinterpret_cast<const std::int32_t*>(depth);
  VI32 low = hn::LoadU(d, stored), high = low;
  for (std::size_t i = hn::Lanes(d); i < kPixels; i += hn::Lanes(d)) {
    const VI32 z = hn::LoadU(d, stored + i);
    low = hn::Min(low, z);
    high = hn::Max(high, z);
  }
  least = static_cast<std::uint32_t>(hn::GetLane(hn::MinOfLanes(d, low)));
  greatest = static_cast<std::uint32_t>(hn::GetLane(hn::MaxOfLanes(d, high)));
}

DecidedBlocks compare_ranges(const BlockDepths& depths, const std::uint32_t* least,
                             const std::uint32_t* greatest, std::int32_t below_slack,
                             std::int32_t above_slack) noexcept {
  const DI32 d;
  RunningSums low = block_sums(depths.low, depths.low_step_x, depths.low_step_y);
  RunningSums high = block_sums(depths.high, depths.high_step_x, depths.high_step_y);
  const VI32 floor = hn::Set(d, depths.least), ceiling = hn::Set(d, depths.greatest);
  const VI32 below = hn::Set(d, below_slack), above = hn::Set(d, above_slack);
  DecidedBlocks decided;
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const VI32 bottom = hn::Min(hn::Max(hn::BitCast(d, low.next(i)), floor), ceiling);
    const VI32 top = hn::Max(hn::Min(hn::BitCast(d, high.next(i)), ceiling), floor);
    const VI32 stored_least = hn::LoadU(d, reinterpret_cast<const std::int32_t*>(least) + i);
    const VI32 stored_greatest = hn::LoadU(d, reinterpret_cast<const std::int32_t*>(greatest) + i);
    decided.below |= pixels_of(d, hn::Lt(top, hn::Add(stored_least, below)), i);
    decided.above |= pixels_of(d, hn::Gt(bottom, hn::Sub(stored_greatest, above)), i);
  }
  return decided;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
