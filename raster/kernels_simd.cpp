// The kernels for every vector instruction set, written once with Highway and compiled once for
// each (foreach_target.h includes this file again and again). Integers throughout, but for the
// transform: its products and sums are apart (Mul, Add), so nothing is fused.
// This file includes no header whose inline functions could be compiled here for a wide instruction
// set and then be kept by the linker for everyone.
#include "raster/kernels.h"

// Ice Lake's AVX-512 is not compiled unless it is asked for.
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/kernels_simd.cpp"
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

// A machine without vectors has the kernels in plain C++.
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

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

/// x * step_x + y * step_y for the pixels of a vector whose first lane is pixel (0, 0); sums are
/// modulo 2^32.
HWY_INLINE VU32 lane_steps(DU32 d, std::uint32_t step_x, std::uint32_t step_y) {
  const VU32 lane = hn::Iota(d, 0);
  const VU32 x = hn::And(lane, hn::Set(d, kWidth - 1)), y = hn::ShiftRight<3>(lane);
  return hn::Add(hn::Mul(x, hn::Set(d, step_x)), hn::Mul(y, hn::Set(d, step_y)));
}

/// The plane's value at pixel `first` of a block.
HWY_INLINE std::uint32_t value_at(std::uint32_t base, std::uint32_t step_x, std::uint32_t step_y,
                                  std::size_t first) {
  return base + static_cast<std::uint32_t>(first % kWidth) * step_x +
         static_cast<std::uint32_t>(first / kWidth) * step_y;
}

PixelMask cover_block(const BlockEdges& edges) noexcept {
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

/// The 64 depths of a plane, vector by vector.
class Depths {
 public:
  explicit HWY_INLINE Depths(const BlockDepth& plane) : plane_(plane) {
    if (plane.narrow)
      steps_ = lane_steps(DU32(), static_cast<std::uint32_t>(plane.step_x),
                          static_cast<std::uint32_t>(plane.step_y));
    else
      wide_depth_values(plane, wide_);
  }
  HWY_INLINE VI32 at(std::size_t i) const {
    const DU32 d;
    if (!plane_.narrow) return hn::BitCast(DI32(), hn::LoadU(d, wide_ + i));
    const std::uint32_t base =
        value_at(static_cast<std::uint32_t>(plane_.base), static_cast<std::uint32_t>(plane_.step_x),
                 static_cast<std::uint32_t>(plane_.step_y), i);
    const VU32 value = hn::Add(hn::Set(d, base), steps_);
    return hn::BitCast(
        DI32(), plane_.fraction_bits == 8 ? hn::ShiftRight<8>(value) : hn::ShiftRight<16>(value));
  }

 private:
  const BlockDepth& plane_;
  VU32 steps_;
  std::uint32_t wide_[kPixels];
};

/// Of the pixels `candidates` those whose depth stands in the relation (or, with `opposite`, does
/// not); they are written if asked for. Depths have at most 24 bits, so signed comparison is right.
template <Relation kRelation>
HWY_INLINE PixelMask related_depths(const Depths& depths, bool opposite, bool write,
                                    PixelMask candidates, std::uint32_t* depth) {
  const DI32 d;
  auto* const stored = reinterpret_cast<std::int32_t*>(depth);
  PixelMask passed = 0;
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const VI32 z = depths.at(i);
    auto mask = related<kRelation>(z, hn::LoadU(d, stored + i));
    if (opposite) mask = hn::Not(mask);
    const PixelMask here = pixels_of(d, mask, i) & candidates;
    if (write && here) hn::BlendedStore(z, lanes_of(d, here, i), d, stored + i);
    passed |= here;
  }
  return passed;
}

HWY_INLINE void write_depths(const Depths& depths, PixelMask pixels, std::uint32_t* depth) {
  const DI32 d;
  auto* const stored = reinterpret_cast<std::int32_t*>(depth);
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d))
    hn::BlendedStore(depths.at(i), lanes_of(d, pixels, i), d, stored + i);
}

HWY_INLINE PixelMask test_depth(const FragmentTests& tests, PixelMask candidates,
                                const BlockDepth& plane, std::uint32_t* depth) {
  if (tests.depth_func == CompareFunc::never) return 0;
  const Depths depths(plane);
  if (tests.depth_func == CompareFunc::always) {
    if (tests.depth_write) write_depths(depths, candidates, depth);
    return candidates;
  }
  const Comparison c = comparison(tests.depth_func);
  switch (c.relation) {
    case Relation::less:
      return related_depths<Relation::less>(depths, c.opposite, tests.depth_write, candidates,
                                            depth);
    case Relation::equal:
      return related_depths<Relation::equal>(depths, c.opposite, tests.depth_write, candidates,
                                             depth);
    default:
      return related_depths<Relation::greater>(depths, c.opposite, tests.depth_write, candidates,
                                               depth);
  }
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

PixelMask test_block(const FragmentTests& tests, PixelMask covered, const BlockDepth& plane,
                     std::uint32_t* depth, std::uint8_t* stencil) noexcept {
  PixelMask stencil_pass = covered;
  if (tests.stencil_test) {
    stencil_pass &= test_stencil(tests, stencil);
    update_stencil(tests.stencil.fail, covered & ~stencil_pass, tests, stencil);
  }
  PixelMask pass = stencil_pass;
  if (tests.depth_test && stencil_pass) pass = test_depth(tests, stencil_pass, plane, depth);
  if (tests.stencil_test) {
    update_stencil(tests.stencil.depth_fail, stencil_pass & ~pass, tests, stencil);
    update_stencil(tests.stencil.pass, pass, tests, stencil);
  }
  return pass;
}

/// Four channels of some pixels, a vector of 32-bit integers each.
struct Channels {
  VI32 c[4];
};

HWY_INLINE Channels unpack(VU32 pixels) {
  const DU32 d;
  const DI32 signed_d;
  const VU32 byte = hn::Set(d, 0xff);
  return {{hn::BitCast(signed_d, hn::And(pixels, byte)),
           hn::BitCast(signed_d, hn::And(hn::ShiftRight<8>(pixels), byte)),
           hn::BitCast(signed_d, hn::And(hn::ShiftRight<16>(pixels), byte)),
           hn::BitCast(signed_d, hn::ShiftRight<24>(pixels))}};
}

HWY_INLINE VU32 pack(const Channels& channels) {
  const DU32 d;
  return hn::Or(
      hn::Or(hn::BitCast(d, channels.c[0]), hn::ShiftLeft<8>(hn::BitCast(d, channels.c[1]))),
      hn::Or(hn::ShiftLeft<16>(hn::BitCast(d, channels.c[2])),
             hn::ShiftLeft<24>(hn::BitCast(d, channels.c[3]))));
}

HWY_INLINE VI32 factor(BlendFactor f, std::size_t c, const Channels& src, const Channels& dst,
                       const std::uint8_t (&constant)[4]) {
  const DI32 d;
  const VI32 one = hn::Set(d, 255);
  switch (f) {
    case BlendFactor::zero:
      return hn::Zero(d);
    case BlendFactor::one:
      return one;
    case BlendFactor::src_color:
      return src.c[c];
    case BlendFactor::one_minus_src_color:
      return hn::Sub(one, src.c[c]);
    case BlendFactor::dst_color:
      return dst.c[c];
    case BlendFactor::one_minus_dst_color:
      return hn::Sub(one, dst.c[c]);
    case BlendFactor::src_alpha:
      return src.c[3];
    case BlendFactor::one_minus_src_alpha:
      return hn::Sub(one, src.c[3]);
    case BlendFactor::dst_alpha:
      return dst.c[3];
    case BlendFactor::one_minus_dst_alpha:
      return hn::Sub(one, dst.c[3]);
    case BlendFactor::constant_color:
      return hn::Set(d, constant[c]);
    case BlendFactor::one_minus_constant_color:
      return hn::Set(d, 255 - constant[c]);
    case BlendFactor::constant_alpha:
      return hn::Set(d, constant[3]);
    case BlendFactor::one_minus_constant_alpha:
      return hn::Set(d, 255 - constant[3]);
    case BlendFactor::src_alpha_saturate:
      return c == 3 ? one : hn::Min(src.c[3], hn::Sub(one, dst.c[3]));
  }
  return hn::Zero(d);
}

HWY_INLINE VI32 blended(const Blend& blend, std::size_t c, const Channels& src, const Channels& dst,
                        const std::uint8_t (&constant)[4]) {
  const DI32 d;
  const BlendOp op = c == 3 ? blend.alpha_op : blend.color_op;
  if (op == BlendOp::min) return hn::Min(src.c[c], dst.c[c]);
  if (op == BlendOp::max) return hn::Max(src.c[c], dst.c[c]);
  const VI32 s =
      hn::Mul(src.c[c], factor(c == 3 ? blend.src_alpha : blend.src_color, c, src, dst, constant));
  const VI32 t =
      hn::Mul(dst.c[c], factor(c == 3 ? blend.dst_alpha : blend.dst_color, c, src, dst, constant));
  const VI32 sum = op == BlendOp::add        ? hn::Add(s, t)
                   : op == BlendOp::subtract ? hn::Sub(s, t)
                                             : hn::Sub(t, s);
  // n / 255 = (n + 1 + n / 256) / 256 for 0 <= n < 65535, quotients rounded down; n <= 65152 here.
  const VI32 n =
      hn::Add(hn::Min(hn::Max(sum, hn::Zero(d)), hn::Set(d, 255 * 255)), hn::Set(d, 127));
  return hn::ShiftRight<8>(hn::Add(hn::Add(n, hn::Set(d, 1)), hn::ShiftRight<8>(n)));
}

void blend_block(const ColorState& state, const std::uint8_t (&constant)[4], PixelMask mask,
                 const std::uint8_t* source, std::uint8_t* stored) noexcept {
  const DU32 d;
  const auto* const from = reinterpret_cast<const std::uint32_t*>(source);
  auto* const to = reinterpret_cast<std::uint32_t*>(stored);
  std::uint32_t channels = 0;
  for (std::size_t c = 0; c < 4; ++c)
    if (state.write[c]) channels |= 0xffu << (8 * c);
  const VU32 write = hn::Set(d, channels);
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const auto here = lanes_of(d, mask, i);
    if (hn::AllFalse(d, here)) continue;
    const VU32 old = hn::LoadU(d, to + i);
    VU32 color = hn::LoadU(d, from + i);
    if (state.blend) {
      const Channels src = unpack(color), dst = unpack(old);
      Channels out;
      for (std::size_t c = 0; c < 4; ++c) out.c[c] = blended(*state.blend, c, src, dst, constant);
      color = pack(out);
    }
    const VU32 written = hn::Or(hn::AndNot(write, old), hn::And(write, color));
    hn::StoreU(hn::IfThenElse(here, written, old), d, to + i);
  }
}

/// A vector holds one or more vertices, four floats each; Broadcast works inside each four.
void transform(const glm::mat4& m, const glm::vec4* positions, std::size_t count,
               glm::vec4* out) noexcept {
  const hn::ScalableTag<float> d;
  const hn::FixedTag<float, 4> one_d;
  const auto run = [](auto tag, const float* columns, const float* from, float* to) HWY_ATTR {
    const auto p = hn::LoadU(tag, from);
    const auto x = hn::Mul(hn::LoadDup128(tag, columns), hn::Broadcast<0>(p));
    const auto y = hn::Mul(hn::LoadDup128(tag, columns + 4), hn::Broadcast<1>(p));
    const auto z = hn::Mul(hn::LoadDup128(tag, columns + 8), hn::Broadcast<2>(p));
    const auto w = hn::Mul(hn::LoadDup128(tag, columns + 12), hn::Broadcast<3>(p));
    hn::StoreU(hn::Add(hn::Add(hn::Add(x, y), z), w), tag, to);
  };
  const float* const columns = &m[0].x;
  const auto* const from = reinterpret_cast<const float*>(positions);
  auto* const to = reinterpret_cast<float*>(out);
  const std::size_t a_vector = hn::Lanes(d) / 4;
  std::size_t i = 0;
  for (; i + a_vector <= count; i += a_vector) run(d, columns, from + 4 * i, to + 4 * i);
  for (; i < count; ++i) run(one_d, columns, from + 4 * i, to + 4 * i);
}

const Kernels* kernels_of_this_target() {
  static constexpr Kernels kKernels{cover_block, test_block, blend_block, transform};
  return &kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif

#if HWY_ONCE
namespace gnomon::raster {

const Kernels* simd_kernels(Isa isa) {
  const std::int64_t machine = hwy::SupportedTargets();
  const auto if_machine_has = [machine](std::int64_t target, const Kernels* kernels) {
    return (machine & target) != 0 ? kernels : nullptr;
  };
  (void)if_machine_has;
  switch (isa) {
#if HWY_TARGETS & HWY_SSSE3
    case Isa::ssse3:
      return if_machine_has(HWY_SSSE3, N_SSSE3::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_SSE4
    case Isa::sse4:
      return if_machine_has(HWY_SSE4, N_SSE4::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_AVX2
    case Isa::avx2:
      return if_machine_has(HWY_AVX2, N_AVX2::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_AVX3
    case Isa::avx512:
      return if_machine_has(HWY_AVX3, N_AVX3::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_AVX3_DL
    case Isa::avx512_dl:
      return if_machine_has(HWY_AVX3_DL, N_AVX3_DL::kernels_of_this_target());
#endif
#if HWY_TARGETS & HWY_NEON
    case Isa::neon:
      return if_machine_has(HWY_NEON, N_NEON::kernels_of_this_target());
#endif
    default:
      return nullptr;
  }
}

}  // namespace gnomon::raster
#endif  // HWY_ONCE
