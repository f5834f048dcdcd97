#include "raster/blend.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::raster {

namespace {

/// A factor for channel c of a colour type T with unit `one`.
template <class T, class Color>
T factor(BlendFactor f, std::size_t c, const Color& src, const Color& dst, const Color& constant,
         T one) {
  switch (f) {
    case BlendFactor::zero:
      return T{0};
    case BlendFactor::one:
      return one;
    case BlendFactor::src_color:
      return src[c];
    case BlendFactor::one_minus_src_color:
      return one - src[c];
    case BlendFactor::dst_color:
      return dst[c];
    case BlendFactor::one_minus_dst_color:
      return one - dst[c];
    case BlendFactor::src_alpha:
      return src[3];
    case BlendFactor::one_minus_src_alpha:
      return one - src[3];
    case BlendFactor::dst_alpha:
      return dst[3];
    case BlendFactor::one_minus_dst_alpha:
      return one - dst[3];
    case BlendFactor::constant_color:
      return constant[c];
    case BlendFactor::one_minus_constant_color:
      return one - constant[c];
    case BlendFactor::constant_alpha:
      return constant[3];
    case BlendFactor::one_minus_constant_alpha:
      return one - constant[3];
    case BlendFactor::src_alpha_saturate:
      return c == 3 ? one : std::min<T>(src[3], one - dst[3]);
  }
  return T{0};
}

/// The four channels combined in type T, where products carry a factor `one`; min and max do not
/// use factors.
template <class T>
std::array<T, 4> combine(const Blend& blend, const std::array<T, 4>& src,
                         const std::array<T, 4>& dst, const std::array<T, 4>& constant, T one) {
  std::array<T, 4> out{};
  for (std::size_t c = 0; c < 4; ++c) {
    const bool alpha = c == 3;
    const BlendOp op = alpha ? blend.alpha_op : blend.color_op;
    const T s =
        src[c] * factor(alpha ? blend.src_alpha : blend.src_color, c, src, dst, constant, one);
    const T d =
        dst[c] * factor(alpha ? blend.dst_alpha : blend.dst_color, c, src, dst, constant, one);
    switch (op) {
      case BlendOp::add:
        out[c] = s + d;
        break;
      case BlendOp::subtract:
        out[c] = s - d;
        break;
      case BlendOp::reverse_subtract:
        out[c] = d - s;
        break;
      case BlendOp::min:
        out[c] = std::min(src[c], dst[c]) * one;
        break;
      case BlendOp::max:
        out[c] = std::max(src[c], dst[c]) * one;
        break;
    }
  }
  return out;
}

std::array<int, 4> widened(const Rgba8& c) { return {c[0], c[1], c[2], c[3]}; }
std::array<float, 4> channels(const glm::vec4& c) { return {c.r, c.g, c.b, c.a}; }

}  // namespace

Rgba8 blend_rgba8(const ColorState& state, const Rgba8& constant, const Rgba8& source,
                  const Rgba8& stored) noexcept {
  Rgba8 out = source;
  if (state.blend) {
    const std::array<int, 4> sum =
        combine<int>(*state.blend, widened(out), widened(stored), widened(constant), 255);
    for (std::size_t c = 0; c < 4; ++c)
      out[c] = static_cast<std::uint8_t>((std::clamp(sum[c], 0, 255 * 255) + 127) / 255);
  }
  for (std::size_t c = 0; c < 4; ++c)
    if (!state.write[c]) out[c] = stored[c];
  return out;
}

glm::vec4 blend_rgba32f(const ColorState& state, const glm::vec4& source,
                        const glm::vec4& stored) noexcept {
  std::array<float, 4> out = channels(source);
  if (state.blend)
    out =
        combine<float>(*state.blend, out, channels(stored), channels(state.blend->constant), 1.0f);
  for (std::size_t c = 0; c < 4; ++c) {
    const float old = stored[static_cast<int>(c)];
    // A processor's own NaN may be negative or not.
    if (std::isnan(out[c]))
      out[c] = std::isnan(old) ? old : std::numeric_limits<float>::quiet_NaN();
    if (!state.write[c]) out[c] = old;
  }
  return {out[0], out[1], out[2], out[3]};
}

}  // namespace gnomon::raster
