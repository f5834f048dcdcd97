// Vector kernels: stencil counts of a shadow volume, per pixel and per block.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_COUNT_BLOCKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_COUNT_BLOCKS_INL_H
#undef GNOMON_RASTER_COUNT_BLOCKS_INL_H
#else
#define GNOMON_RASTER_COUNT_BLOCKS_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"
#include "raster/test_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

/// Adds delta to the pixels' stencils.
HWY_INLINE void add_to_pixels(VU8 delta, PixelMask pixels, std::uint8_t* stencil) {
  const DU8 d;
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const VU8 old = hn::LoadU(d, stencil + i);
    hn::StoreU(hn::Add(old, hn::IfThenElseZero(lanes_of(d, pixels, i), delta)), d, stencil + i);
  }
}

template <Relation kRelation>
HWY_INLINE void count_related(bool opposite, std::uint8_t delta, const TestedBlocks& tested,
                              const PixelMask* covered) {
  const DU8 d;
  const VU8 deltas = hn::Set(d, delta);
  // Pixels outside the relation count where `opposite`, as a mask to flip with.
  const PixelMask flip = opposite ? kAllPixels : 0;
  for (BlockMask rest = tested.blocks; rest; rest &= rest - 1) {
    const auto b = static_cast<std::size_t>(__builtin_ctzll(rest));
    const PixelMask pixels =
        (related_depths<kRelation>(tested.plane, b, tested.depth + b * kPixels, covered[b]) ^
         flip) &
        covered[b];
    if (pixels) add_to_pixels(deltas, pixels, tested.stencil + b * kPixels);
  }
}

void count_blocks(CompareFunc func, bool on_pass, std::uint8_t delta, const TestedBlocks& tested,
                  const PixelMask* covered) noexcept {
  const DU8 d;
  const BlockMask whole = on_pass ? tested.depth_passes : tested.depth_fails;
  for (BlockMask rest = tested.blocks & whole; rest; rest &= rest - 1) {
    const auto b = static_cast<std::size_t>(__builtin_ctzll(rest));
    add_to_pixels(hn::Set(d, delta), covered[b], tested.stencil + b * kPixels);
  }
  TestedBlocks open = tested;
  open.blocks &= ~(tested.depth_passes | tested.depth_fails);
  if (!open.blocks) return;
  const Comparison c = comparison(func);
  const bool opposite = c.opposite == on_pass;
  switch (c.relation) {
    case Relation::less:
      return count_related<Relation::less>(opposite, delta, open, covered);
    case Relation::equal:
      return count_related<Relation::equal>(opposite, delta, open, covered);
    case Relation::greater:
      return count_related<Relation::greater>(opposite, delta, open, covered);
  }
}

void add_to_blocks(const std::uint8_t* deltas, std::uint8_t* stencil) noexcept {
  const DU8 d;
  for (std::size_t b = 0; b < kPixels; ++b)
    if (deltas[b]) add_to_pixels(hn::Set(d, deltas[b]), kAllPixels, stencil + b * kPixels);
}

BlockMask stencil_blocks(const FragmentTests& tests, const std::uint8_t* stencil) noexcept {
  BlockMask blocks = 0;
  for (std::size_t b = 0; b < kPixels; ++b)
    if (test_stencil(tests, stencil + b * kPixels)) blocks |= BlockMask{1} << b;
  return blocks;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
