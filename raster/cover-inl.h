// Vector kernels: which blocks of a tile, and which pixels of a block, lie inside a triangle's
// edges. Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_COVER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_COVER_INL_H
#undef GNOMON_RASTER_COVER_INL_H
#else
#define GNOMON_RASTER_COVER_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

/// Sums over the 8x8 blocks of a tile.
HWY_INLINE RunningSums block_sums(std::int32_t value, std::int32_t step_x, std::int32_t step_y) {
  const auto dx = static_cast<std::uint32_t>(step_x), dy = static_cast<std::uint32_t>(step_y);
  return {lane_steps(DU32(), dx, dy), static_cast<std::uint32_t>(value), dx, dy};
}

HWY_INLINE PixelMask negative(VU32 sums, std::size_t i) {
  const DI32 d;
  return pixels_of(d, hn::Lt(hn::BitCast(d, sums), hn::Zero(d)), i);
}

BlockMask cover_blocks(const TileEdges& edges, BlockMask& filled) noexcept {
  constexpr std::int32_t kSpan = kWidth - 1;
  BlockMask outside = 0, crossed = 0;
  for (int k = 0; k < edges.count; ++k) {
    const std::int32_t dx = edges.step_x[k], dy = edges.step_y[k];
    const std::int32_t up = (dx > 0 ? dx : 0) + (dy > 0 ? dy : 0),
                       down = (dx < 0 ? dx : 0) + (dy < 0 ? dy : 0);
    RunningSums greatest = block_sums(edges.value[k] + up * kSpan, dx * 8, dy * 8);
    const VU32 spread = hn::Set(DU32(), static_cast<std::uint32_t>((down - up) * kSpan));
    for (std::size_t i = 0; i < kPixels; i += hn::Lanes(DU32())) {
      const VU32 sums = greatest.next(i);
      outside |= negative(sums, i);
      crossed |= negative(hn::Add(sums, spread), i);
    }
  }
  filled = ~crossed;
  return ~outside;
}

HWY_INLINE PixelMask not_negative(VU32 sums, std::size_t i) {
  const DI32 d;
  return pixels_of(d, hn::Not(hn::Lt(hn::BitCast(d, sums), hn::Zero(d))), i);
}

/// The vectors of block b with the rows that the edges are for.
HWY_INLINE VectorRange rows_of(DU32 d, const TileEdges& edges, std::uint32_t b) {
  const int below = static_cast<int>(b / 8 * 8);
  const int first = edges.first_row > below ? edges.first_row - below : 0;
  const int end = edges.end_row < below + 8 ? edges.end_row - below : 8;
  return {static_cast<std::size_t>(first) * kWidth & ~(rows_at_once(d) * kWidth - 1),
          static_cast<std::size_t>(end) * kWidth};
}

template <int kCount>
HWY_INLINE BlockMask cover_pixels_of(const TileEdges& edges, BlockMask blocks, PixelMask* covered) {
  const DU32 d;
  VU32 lanes[kCount];
  for (int k = 0; k < kCount; ++k)
    lanes[k] = lane_steps(d, static_cast<std::uint32_t>(edges.step_x[k]),
                          static_cast<std::uint32_t>(edges.step_y[k]));
  BlockMask touched = 0;
  for (BlockMask rest = blocks; rest; rest &= rest - 1) {
    const auto b = static_cast<std::uint32_t>(__builtin_ctzll(rest));
    const VectorRange range = rows_of(d, edges, b);
    const auto sums_of = [&](int k) HWY_ATTR {
      const auto dx = static_cast<std::uint32_t>(edges.step_x[k]),
                 dy = static_cast<std::uint32_t>(edges.step_y[k]);
      return RunningSums(
          lanes[k], static_cast<std::uint32_t>(edges.value[k]) + b % 8 * 8 * dx + b / 8 * 8 * dy,
          dx, dy, range.first / kWidth);
    };
    RunningSums first = sums_of(0), second = sums_of(kCount > 1 ? 1 : 0),
                third = sums_of(kCount > 2 ? 2 : 0);
    PixelMask inside = 0;
    for (std::size_t i = range.first; i < range.end; i += hn::Lanes(d)) {
      // A pixel is out if any edge's sign bit is set there.
      VU32 any = first.next(i);
      if constexpr (kCount > 1) any = hn::Or(any, second.next(i));
      if constexpr (kCount > 2) any = hn::Or(any, third.next(i));
      inside |= not_negative(any, i);
    }
    covered[b] = inside;
    if (inside) touched |= BlockMask{1} << b;
  }
  return touched;
}

BlockMask cover_pixels(const TileEdges& edges, BlockMask blocks, PixelMask* covered) noexcept {
  switch (edges.count) {
    case 1:
      return cover_pixels_of<1>(edges, blocks, covered);
    case 2:
      return cover_pixels_of<2>(edges, blocks, covered);
    case 3:
      return cover_pixels_of<3>(edges, blocks, covered);
    default:
      for (BlockMask rest = blocks; rest; rest &= rest - 1)
        covered[__builtin_ctzll(rest)] = kAllPixels;
      return blocks;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
