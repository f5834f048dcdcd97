#include "llvmpipe_blend.h"

#include <algorithm>

#include "raster/unorm.h"

namespace gnomon::peer {

using namespace gnomon::raster;

namespace {

int rounded_product(int a, int b) {
  const int product = a * b;
  return (product + (product >> 8) + 128) >> 8;
}

int factor(BlendFactor f, std::size_t c, const Rgba8& src, const Rgba8& dst, const Rgba8& k) {
  switch (f) {
    case BlendFactor::zero:
      return 0;
    case BlendFactor::one:
      return 255;
    case BlendFactor::src_color:
      return src[c];
    case BlendFactor::one_minus_src_color:
      return 255 - src[c];
    case BlendFactor::dst_color:
      return dst[c];
    case BlendFactor::one_minus_dst_color:
      return 255 - dst[c];
    case BlendFactor::src_alpha:
      return src[3];
    case BlendFactor::one_minus_src_alpha:
      return 255 - src[3];
    case BlendFactor::dst_alpha:
      return dst[3];
    case BlendFactor::one_minus_dst_alpha:
      return 255 - dst[3];
    case BlendFactor::constant_color:
      return k[c];
    case BlendFactor::one_minus_constant_color:
      return 255 - k[c];
    case BlendFactor::constant_alpha:
      return k[3];
    case BlendFactor::one_minus_constant_alpha:
      return 255 - k[3];
    case BlendFactor::src_alpha_saturate:
      return c == 3 ? 255 : std::min<int>(src[3], 255 - dst[3]);
  }
  return 0;
}

}  // namespace

Rgba8 llvmpipe_blend(const ColorState& state, const Rgba8& source, const Rgba8& stored) {
  Rgba8 out = source;
  for (std::size_t c = 0; c < 4; ++c) {
    if (state.blend) {
      const Blend& blend = *state.blend;
      const Rgba8 k = to_rgba8(blend.constant);
      const BlendOp op = c == 3 ? blend.alpha_op : blend.color_op;
      const int s = rounded_product(
          source[c], factor(c == 3 ? blend.src_alpha : blend.src_color, c, source, stored, k));
      const int d = rounded_product(
          stored[c], factor(c == 3 ? blend.dst_alpha : blend.dst_color, c, source, stored, k));
      const int value = op == BlendOp::add                ? s + d
                        : op == BlendOp::subtract         ? s - d
                        : op == BlendOp::reverse_subtract ? d - s
                        : op == BlendOp::min              ? std::min(source[c], stored[c])
                                                          : std::max(source[c], stored[c]);
      out[c] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
    }
    if (!state.write[c]) out[c] = stored[c];
  }
  return out;
}

}  // namespace gnomon::peer
