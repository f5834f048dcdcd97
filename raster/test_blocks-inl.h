// Vector kernel: stencil test, depth test, stencil update and depth write, block by block.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_TEST_BLOCKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_TEST_BLOCKS_INL_H
#undef GNOMON_RASTER_TEST_BLOCKS_INL_H
#else
#define GNOMON_RASTER_TEST_BLOCKS_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

/// The six comparisons that are neither `never` nor `always` are these three and their opposites.
enum class Relation { less, equal, greater };

struct Comparison {
  Relation relation;
  bool opposite;
};

HWY_INLINE Comparison comparison(CompareFunc func) {
  switch (func) {
    case CompareFunc::less:
      return {Relation::less, false};
    case CompareFunc::greater_equal:
      return {Relation::less, true};
    case CompareFunc::equal:
      return {Relation::equal, false};
    case CompareFunc::not_equal:
      return {Relation::equal, true};
    case CompareFunc::greater:
      return {Relation::greater, false};
    default:
      return {Relation::greater, true};
  }
}

template <Relation kRelation, class V>
HWY_INLINE auto related(V a, V b) {
  if constexpr (kRelation == Relation::less) return hn::Lt(a, b);
  if constexpr (kRelation == Relation::equal) return hn::Eq(a, b);
  if constexpr (kRelation == Relation::greater) return hn::Gt(a, b);
}

template <Relation kRelation>
HWY_INLINE PixelMask related_stencils(std::uint8_t ref, std::uint8_t read_mask,
                                      const std::uint8_t* stencil) {
  const DU8 d;
  const VU8 left = hn::Set(d, ref & read_mask), read = hn::Set(d, read_mask);
  PixelMask mask = 0;
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d))
    mask |= pixels_of(d, related<kRelation>(left, hn::And(hn::LoadU(d, stencil + i), read)), i);
  return mask;
}

HWY_INLINE PixelMask test_stencil(const FragmentTests& tests, const std::uint8_t* stencil) {
  const StencilFace& face = tests.stencil;
  if (face.func == CompareFunc::always) return kAllPixels;
  if (face.func == CompareFunc::never) return 0;
  const Comparison c = comparison(face.func);
  PixelMask mask = 0;
  switch (c.relation) {
    case Relation::less:
      mask = related_stencils<Relation::less>(tests.stencil_ref, face.read_mask, stencil);
      break;
    case Relation::equal:
      mask = related_stencils<Relation::equal>(tests.stencil_ref, face.read_mask, stencil);
      break;
    case Relation::greater:
      mask = related_stencils<Relation::greater>(tests.stencil_ref, face.read_mask, stencil);
      break;
  }
  return c.opposite ? ~mask : mask;
}

/// The 64 depths of a block, of a plane that is not narrow, clamped to [low, high], in 64-bit
/// lanes.
HWY_INLINE void wide_depths(const TileDepth& plane, std::uint64_t base, std::uint32_t* out) {
  const hn::CappedTag<std::uint64_t, kWidth> d;
  const hn::RebindToSigned<decltype(d)> signed_d;
  const hn::Rebind<std::uint32_t, decltype(d)> narrow_d;
  std::uint64_t row[kWidth];
  for (std::size_t x = 0; x < kWidth; ++x) row[x] = base + x * plane.step_x;
  const auto low = hn::Set(signed_d, static_cast<std::int64_t>(plane.low));
  const auto high = hn::Set(signed_d, static_cast<std::int64_t>(plane.high));
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const auto up = hn::Set(d, (i / kWidth) * plane.step_y);
    const auto value = hn::BitCast(signed_d, hn::Add(hn::LoadU(d, row + i % kWidth), up));
    const auto depth =
        plane.fraction_bits == 8 ? hn::ShiftRight<8>(value) : hn::ShiftRight<16>(value);
    const auto clamped = hn::Min(hn::Max(depth, low), high);
    hn::StoreU(hn::TruncateTo(narrow_d, hn::BitCast(d, clamped)), narrow_d, out + i);
  }
}

/// The depths of a plane in block b of the tile, a vector after the other (RunningSums::next).
class Depths {
 public:
  HWY_INLINE Depths(const TileDepth& plane, std::size_t b, std::size_t first_row)
      : narrow_(plane.narrow),
        fraction_bits_(plane.fraction_bits),
        sums_(sums_of(plane, base_of(plane, b), first_row)) {
    if (!narrow_) wide_depths(plane, base_of(plane, b), wide_);
  }
  HWY_INLINE VI32 next(std::size_t i) {
    const DU32 d;
    if (!narrow_) return hn::BitCast(DI32(), hn::LoadU(d, wide_ + i));
    const VU32 value = sums_.next(i);
    return hn::BitCast(DI32(),
                       fraction_bits_ == 8 ? hn::ShiftRight<8>(value) : hn::ShiftRight<16>(value));
  }

 private:
  static HWY_INLINE std::uint64_t base_of(const TileDepth& plane, std::size_t b) {
    return plane.base + b % 8 * 8 * plane.step_x + b / 8 * 8 * plane.step_y;
  }
  static HWY_INLINE RunningSums sums_of(const TileDepth& plane, std::uint64_t base,
                                        std::size_t first_row) {
    const auto dx = static_cast<std::uint32_t>(plane.step_x),
               dy = static_cast<std::uint32_t>(plane.step_y);
    return {lane_steps(DU32(), dx, dy), static_cast<std::uint32_t>(base), dx, dy, first_row};
  }

  const bool narrow_;
  const int fraction_bits_;
  RunningSums sums_;
  std::uint32_t wide_[kPixels];
};

/// The pixels whose depth stands in the relation to the stored one, where they lie in a vector with
/// one of `candidates`. Depths have at most 24 bits, so signed comparison is right.
template <Relation kRelation>
HWY_INLINE PixelMask related_depths(const TileDepth& plane, std::size_t b,
                                    const std::uint32_t* depth, PixelMask candidates) {
  const DI32 d;
  const auto* const stored = reinterpret_cast<const std::int32_t*>(depth);
  const VectorRange range = vectors_of(d, candidates);
  Depths depths(plane, b, range.first / kWidth);
  PixelMask mask = 0;
  for (std::size_t i = range.first; i < range.end; i += hn::Lanes(d))
    mask |= pixels_of(d, related<kRelation>(depths.next(i), hn::LoadU(d, stored + i)), i);
  return mask;
}

HWY_INLINE void write_depths(const TileDepth& plane, std::size_t b, PixelMask pixels,
                             std::uint32_t* depth) {
  const DI32 d;
  auto* const stored = reinterpret_cast<std::int32_t*>(depth);
  const VectorRange range = vectors_of(d, pixels);
  Depths depths(plane, b, range.first / kWidth);
  for (std::size_t i = range.first; i < range.end; i += hn::Lanes(d))
    hn::BlendedStore(depths.next(i), lanes_of(d, pixels, i), d, stored + i);
}

/// The same; of the candidates, those that stand in the relation (or the others, if `opposite`),
/// and their depths are written.
template <Relation kRelation>
HWY_INLINE PixelMask replace_related_depths(bool opposite, const TileDepth& plane, std::size_t b,
                                            PixelMask candidates, std::uint32_t* depth) {
  const DI32 d;
  auto* const stored = reinterpret_cast<std::int32_t*>(depth);
  const VectorRange range = vectors_of(d, candidates);
  Depths depths(plane, b, range.first / kWidth);
  PixelMask passed = 0;
  for (std::size_t i = range.first; i < range.end; i += hn::Lanes(d)) {
    const VI32 fresh = depths.next(i);
    auto pass = related<kRelation>(fresh, hn::LoadU(d, stored + i));
    if (opposite) pass = hn::Not(pass);
    pass = hn::And(pass, lanes_of(d, candidates, i));
    hn::BlendedStore(fresh, pass, d, stored + i);
    passed |= pixels_of(d, pass, i);
  }
  return passed;
}

/// Of the pixels `candidates`, which are some, those that pass.
HWY_INLINE PixelMask compare_depths(CompareFunc func, const TileDepth& plane, std::size_t b,
                                    const std::uint32_t* depth, PixelMask candidates) {
  if (func == CompareFunc::never) return 0;
  if (func == CompareFunc::always) return candidates;
  const Comparison c = comparison(func);
  PixelMask mask = 0;
  switch (c.relation) {
    case Relation::less:
      mask = related_depths<Relation::less>(plane, b, depth, candidates);
      break;
    case Relation::equal:
      mask = related_depths<Relation::equal>(plane, b, depth, candidates);
      break;
    case Relation::greater:
      mask = related_depths<Relation::greater>(plane, b, depth, candidates);
      break;
  }
  return candidates & (c.opposite ? ~mask : mask);
}

/// compare_depths, and the depths of those that pass are written.
HWY_INLINE PixelMask replace_depths(CompareFunc func, const TileDepth& plane, std::size_t b,
                                    std::uint32_t* depth, PixelMask candidates) {
  if (func == CompareFunc::never) return 0;
  if (func == CompareFunc::always) {
    write_depths(plane, b, candidates, depth);
    return candidates;
  }
  const Comparison c = comparison(func);
  switch (c.relation) {
    case Relation::less:
      return replace_related_depths<Relation::less>(c.opposite, plane, b, candidates, depth);
    case Relation::equal:
      return replace_related_depths<Relation::equal>(c.opposite, plane, b, candidates, depth);
    case Relation::greater:
      return replace_related_depths<Relation::greater>(c.opposite, plane, b, candidates, depth);
  }
  return 0;
}

/// Of the pixels `candidates` of block b, which are some, those that pass the depth test; they are
/// written if asked for.
HWY_INLINE PixelMask test_depth(const FragmentTests& tests, const TestedBlocks& tested,
                                std::size_t b, PixelMask candidates) {
  const bool passes = (tested.depth_passes >> b & 1) != 0;
  if ((tested.depth_fails >> b & 1) != 0) return 0;
  if (passes && !tests.depth_write) return candidates;
  std::uint32_t* const depth = tested.depth + b * kPixels;
  if (!tests.depth_write)
    return compare_depths(tests.depth_func, tested.plane, b, depth, candidates);
  return replace_depths(passes ? CompareFunc::always : tests.depth_func, tested.plane, b, depth,
                        candidates);
}

HWY_INLINE VU8 apply(StencilOp op, VU8 value, VU8 ref) {
  const DU8 d;
  const VU8 one = hn::Set(d, 1);
  switch (op) {
    case StencilOp::keep:
      return value;
    case StencilOp::zero:
      return hn::Zero(d);
    case StencilOp::replace:
      return ref;
    case StencilOp::incr:
      return hn::SaturatedAdd(value, one);
    case StencilOp::incr_wrap:
      return hn::Add(value, one);
    case StencilOp::decr:
      return hn::SaturatedSub(value, one);
    case StencilOp::decr_wrap:
      return hn::Sub(value, one);
    case StencilOp::invert:
      return hn::Not(value);
  }
  return value;
}

HWY_INLINE void update_stencil(StencilOp op, PixelMask pixels, const FragmentTests& tests,
                               std::uint8_t* stencil) {
  const std::uint8_t write_mask = tests.stencil.write_mask;
  if (op == StencilOp::keep || write_mask == 0 || pixels == 0) return;
  const DU8 d;
  const VU8 ref = hn::Set(d, tests.stencil_ref), write = hn::Set(d, write_mask);
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const VU8 old = hn::LoadU(d, stencil + i);
    const VU8 changed = hn::Or(hn::AndNot(write, old), hn::And(write, apply(op, old, ref)));
    hn::StoreU(hn::IfThenElse(lanes_of(d, pixels, i), changed, old), d, stencil + i);
  }
}

HWY_INLINE PixelMask test_block(const FragmentTests& tests, const TestedBlocks& tested,
                                std::size_t b, PixelMask covered) {
  std::uint8_t* const stencil = tests.stencil_test ? tested.stencil + b * kPixels : nullptr;
  PixelMask stencil_pass = covered;
  if (stencil) {
    stencil_pass &= test_stencil(tests, stencil);
    update_stencil(tests.stencil.fail, covered & ~stencil_pass, tests, stencil);
  }
  PixelMask pass = stencil_pass;
  if (tests.depth_test && stencil_pass) pass = test_depth(tests, tested, b, stencil_pass);
  if (stencil) {
    update_stencil(tests.stencil.depth_fail, stencil_pass & ~pass, tests, stencil);
    update_stencil(tests.stencil.pass, pass, tests, stencil);
  }
  return pass;
}

BlockMask test_blocks(const FragmentTests& tests, const TestedBlocks& tested,
                      PixelMask* covered) noexcept {
  BlockMask passed = 0;
  for (BlockMask rest = tested.blocks; rest; rest &= rest - 1) {
    const auto b = static_cast<std::size_t>(__builtin_ctzll(rest));
    covered[b] = test_block(tests, tested, b, covered[b]);
    if (covered[b]) passed |= BlockMask{1} << b;
  }
  return passed;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
