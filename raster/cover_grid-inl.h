// Vector kernel: which of 8x8 samples lie inside a triangle's edges.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_COVER_GRID_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_COVER_GRID_INL_H
#undef GNOMON_RASTER_COVER_GRID_INL_H
#else
#define GNOMON_RASTER_COVER_GRID_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

PixelMask cover_grid(const GridEdges& edges) noexcept {
  const DU32 d;
  const DI32 signed_d;
  VU32 steps[3];
  for (int k = 0; k < edges.count; ++k)
    steps[k] = lane_steps(d, static_cast<std::uint32_t>(edges.step_x[k]),
                          static_cast<std::uint32_t>(edges.step_y[k]));
  PixelMask outside = 0;
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    // A pixel is out if any edge's sign bit is set there.
    VU32 any = hn::Zero(d);
    for (int k = 0; k < edges.count; ++k) {
      const std::uint32_t value = value_at(static_cast<std::uint32_t>(edges.value[k]),
                                           static_cast<std::uint32_t>(edges.step_x[k]),
                                           static_cast<std::uint32_t>(edges.step_y[k]), i);
      any = hn::Or(any, hn::Add(hn::Set(d, value), steps[k]));
    }
    outside |= pixels_of(signed_d, hn::Lt(hn::BitCast(signed_d, any), hn::Zero(signed_d)), i);
  }
  return ~outside;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
