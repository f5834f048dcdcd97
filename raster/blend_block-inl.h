// Vector kernels: blending and colour mask (raster/blend.h) of vectors of pixels. RGBA8: in 32-bit
// integers, or where no factor but one has a part in it in bytes that saturate. RGBA32F: the
// operations of raster/blend.cpp.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_BLEND_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_BLEND_BLOCK_INL_H
#undef GNOMON_RASTER_BLEND_BLOCK_INL_H
#else
#define GNOMON_RASTER_BLEND_BLOCK_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

/// Four channels of some pixels, a vector each.
template <class D>
struct Channels {
  hn::Vec<D> c[4];
};

HWY_INLINE Channels<DI32> unpack(VU32 pixels) {
  const DU32 d;
  const DI32 signed_d;
  const VU32 byte = hn::Set(d, 0xff);
  return {{hn::BitCast(signed_d, hn::And(pixels, byte)),
           hn::BitCast(signed_d, hn::And(hn::ShiftRight<8>(pixels), byte)),
           hn::BitCast(signed_d, hn::And(hn::ShiftRight<16>(pixels), byte)),
           hn::BitCast(signed_d, hn::ShiftRight<24>(pixels))}};
}

HWY_INLINE VU32 pack(const Channels<DI32>& channels) {
  const DU32 d;
  return hn::Or(
      hn::Or(hn::BitCast(d, channels.c[0]), hn::ShiftLeft<8>(hn::BitCast(d, channels.c[1]))),
      hn::Or(hn::ShiftLeft<16>(hn::BitCast(d, channels.c[2])),
             hn::ShiftLeft<24>(hn::BitCast(d, channels.c[3]))));
}

/// What std::min and std::max choose, also of a NaN.
template <class V>
HWY_INLINE V lesser(V a, V b) {
  return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class V>
HWY_INLINE V greater(V a, V b) {
  return hn::IfThenElse(hn::Lt(a, b), b, a);
}

/// What is blended: colours of a type T with unit `one`, as integers or floats.
template <class D, class T>
struct Blended {
  const Blend& blend;
  const Channels<D>&src, &dst;
  const T (&constant)[4];
  T one;

  HWY_INLINE hn::Vec<D> factor(BlendFactor f, std::size_t c) const {
    const D d;
    const auto unit = hn::Set(d, one);
    switch (f) {
      case BlendFactor::zero:
        return hn::Zero(d);
      case BlendFactor::one:
        return unit;
      case BlendFactor::src_color:
        return src.c[c];
      case BlendFactor::one_minus_src_color:
        return hn::Sub(unit, src.c[c]);
      case BlendFactor::dst_color:
        return dst.c[c];
      case BlendFactor::one_minus_dst_color:
        return hn::Sub(unit, dst.c[c]);
      case BlendFactor::src_alpha:
        return src.c[3];
      case BlendFactor::one_minus_src_alpha:
        return hn::Sub(unit, src.c[3]);
      case BlendFactor::dst_alpha:
        return dst.c[3];
      case BlendFactor::one_minus_dst_alpha:
        return hn::Sub(unit, dst.c[3]);
      case BlendFactor::constant_color:
        return hn::Set(d, constant[c]);
      case BlendFactor::one_minus_constant_color:
        return hn::Sub(unit, hn::Set(d, constant[c]));
      case BlendFactor::constant_alpha:
        return hn::Set(d, constant[3]);
      case BlendFactor::one_minus_constant_alpha:
        return hn::Sub(unit, hn::Set(d, constant[3]));
      case BlendFactor::src_alpha_saturate:
        return c == 3 ? unit : lesser(src.c[3], hn::Sub(unit, dst.c[3]));
    }
    return hn::Zero(d);
  }

  HWY_INLINE hn::Vec<D> product(hn::Vec<D> value, BlendFactor f, std::size_t c) const {
    if (f == BlendFactor::one) return hn::Mul(value, hn::Set(D(), one));
    return hn::Mul(value, factor(f, c));
  }

  /// Channel c, in units of one * one.
  HWY_INLINE hn::Vec<D> channel(std::size_t c) const {
    const bool alpha = c == 3;
    const BlendOp op = alpha ? blend.alpha_op : blend.color_op;
    if (op == BlendOp::min || op == BlendOp::max)
      return hn::Mul(op == BlendOp::min ? lesser(src.c[c], dst.c[c]) : greater(src.c[c], dst.c[c]),
                     hn::Set(D(), one));
    const auto s = product(src.c[c], alpha ? blend.src_alpha : blend.src_color, c);
    const auto t = product(dst.c[c], alpha ? blend.dst_alpha : blend.dst_color, c);
    return op == BlendOp::add        ? hn::Add(s, t)
           : op == BlendOp::subtract ? hn::Sub(s, t)
                                     : hn::Sub(t, s);
  }
};

/// Over 255, rounded to nearest; sums outside [0, 255 * 255] are clamped to it.
HWY_INLINE VI32 rounded(VI32 sum) {
  const DI32 d;
  // n / 255 = (n + 1 + n / 256) / 256 for 0 <= n < 65535, quotients rounded down; n <= 65152 here.
  const VI32 n =
      hn::Add(hn::Min(hn::Max(sum, hn::Zero(d)), hn::Set(d, 255 * 255)), hn::Set(d, 127));
  return hn::ShiftRight<8>(hn::Add(hn::Add(n, hn::Set(d, 1)), hn::ShiftRight<8>(n)));
}

/// How RGBA8 colours are written over stored ones, found out once for many pixels.
class Rgba8Blend {
 public:
  HWY_INLINE Rgba8Blend(const ColorState& state, const std::uint8_t (&constant)[4])
      : blend_(state.blend ? &*state.blend : nullptr), way_(way_of(state)), written_(0) {
    for (std::size_t c = 0; c < 4; ++c) {
      constant_[c] = constant[c];
      if (state.write[c]) written_ |= 0xffu << (8 * c);
    }
  }

  /// What is stored has no part in the result.
  HWY_INLINE bool replaces() const { return way_ == Way::replace && written_ == ~0u; }

  HWY_INLINE VU32 over(VU32 color, VU32 old) const {
    const DU32 d;
    const hn::Repartition<std::uint8_t, DU32> byte_d;
    const auto src = hn::BitCast(byte_d, color), dst = hn::BitCast(byte_d, old);
    VU32 out = color;
    switch (way_) {
      case Way::replace:
        break;
      case Way::add:
        out = hn::BitCast(d, hn::SaturatedAdd(src, dst));
        break;
      case Way::subtract:
        out = hn::BitCast(d, hn::SaturatedSub(src, dst));
        break;
      case Way::reverse_subtract:
        out = hn::BitCast(d, hn::SaturatedSub(dst, src));
        break;
      case Way::min:
        out = hn::BitCast(d, hn::Min(src, dst));
        break;
      case Way::max:
        out = hn::BitCast(d, hn::Max(src, dst));
        break;
      case Way::with_factors:
        out = with_factors(color, old);
        break;
    }
    const VU32 written = hn::Set(d, written_);
    return hn::Or(hn::AndNot(written, old), hn::And(written, out));
  }

 private:
  enum class Way { replace, add, subtract, reverse_subtract, min, max, with_factors };

  static HWY_INLINE Way way_of(BlendOp op, BlendFactor src, BlendFactor dst) {
    if (op == BlendOp::min) return Way::min;
    if (op == BlendOp::max) return Way::max;
    if (src != BlendFactor::one || dst != BlendFactor::one) return Way::with_factors;
    return op == BlendOp::add        ? Way::add
           : op == BlendOp::subtract ? Way::subtract
                                     : Way::reverse_subtract;
  }
  static HWY_INLINE Way way_of(const ColorState& state) {
    if (!state.blend) return Way::replace;
    const Blend& b = *state.blend;
    const Way color = way_of(b.color_op, b.src_color, b.dst_color);
    const Way alpha = way_of(b.alpha_op, b.src_alpha, b.dst_alpha);
    return color == alpha || !state.write[3] ? color : Way::with_factors;
  }

  HWY_INLINE VU32 with_factors(VU32 color, VU32 old) const {
    const Channels<DI32> src = unpack(color), dst = unpack(old);
    const Blended<DI32, std::int32_t> blended{*blend_, src, dst, constant_, 255};
    Channels<DI32> out;
    for (std::size_t c = 0; c < 4; ++c) out.c[c] = rounded(blended.channel(c));
    return pack(out);
  }

  const Blend* blend_;
  Way way_;
  std::uint32_t written_;
  std::int32_t constant_[4];
};

/// RGBA32F colours written over stored ones.
HWY_INLINE Channels<DF32> blend_floats(const ColorState& state, const Channels<DF32>& color,
                                       const Channels<DF32>& old) {
  const DF32 d;
  const VF32 nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  Channels<DF32> out = color;
  if (state.blend) {
    const glm::vec4& k = state.blend->constant;
    const float constant[4] = {k.x, k.y, k.z, k.w};
    const Blended<DF32, float> blended{*state.blend, color, old, constant, 1.0f};
    for (std::size_t c = 0; c < 4; ++c) out.c[c] = blended.channel(c);
  }
  const auto is_number = [](VF32 v) HWY_ATTR { return hn::Eq(v, v); };
  for (std::size_t c = 0; c < 4; ++c) {
    const VF32 if_nan = hn::IfThenElse(is_number(old.c[c]), nan, old.c[c]);
    out.c[c] = state.write[c] ? hn::IfThenElse(is_number(out.c[c]), out.c[c], if_nan) : old.c[c];
  }
  return out;
}

void fill_block(std::uint32_t color, PixelMask mask, std::uint8_t* stored) noexcept {
  const DU32 d;
  auto* const to = reinterpret_cast<std::uint32_t*>(stored);
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d))
    hn::BlendedStore(hn::Set(d, color), lanes_of(d, mask, i), d, to + i);
}

void blend_block(const ColorState& state, const std::uint8_t (&constant)[4], PixelMask mask,
                 const std::uint8_t* source, std::uint8_t* stored) noexcept {
  const DU32 d;
  const auto* const from = reinterpret_cast<const std::uint32_t*>(source);
  auto* const to = reinterpret_cast<std::uint32_t*>(stored);
  const Rgba8Blend blend(state, constant);
  for (std::size_t i = 0; i < kPixels; i += hn::Lanes(d)) {
    const auto here = lanes_of(d, mask, i);
    if (hn::AllFalse(d, here)) continue;
    const VU32 old = hn::LoadU(d, to + i);
    const VU32 written = blend.over(hn::LoadU(d, from + i), old);
    hn::StoreU(hn::IfThenElse(here, written, old), d, to + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
