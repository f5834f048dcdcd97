// Vector kernel: blending and colour mask of an RGBA8 block, in 32-bit integers.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_BLEND_BLOCK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_BLEND_BLOCK_INL_H
#undef GNOMON_RASTER_BLEND_BLOCK_INL_H
#else
#define GNOMON_RASTER_BLEND_BLOCK_INL_H
#endif

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

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

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
