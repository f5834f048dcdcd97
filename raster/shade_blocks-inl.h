// Vector kernels: the pixels of a tile's blocks shaded, rounded, blended and stored.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_SHADE_BLOCKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_SHADE_BLOCKS_INL_H
#undef GNOMON_RASTER_SHADE_BLOCKS_INL_H
#else
#define GNOMON_RASTER_SHADE_BLOCKS_INL_H
#endif

#include <hwy/highway.h>

#include "raster/blend_block-inl.h"
#include "raster/kernels.h"
#include "raster/lanes-inl.h"
#include "raster/shade_colors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

/// The pixels of lanes [i, i + lanes), of those in the mask.
HWY_INLINE bool any_pixel(PixelMask mask, std::size_t i, std::size_t lanes) {
  return (mask >> i & (~PixelMask{0} >> (kPixels - lanes))) != 0;
}

/// Perspective-correct weights of the mesh triangle's vertices from the scaled edges of as many
/// pixels as there are lanes; they go to places i and on of three planes.
template <class V, std::size_t kCount>
HWY_INLINE void store_weights(const TileWeights& w, V q0, V q1, V q2, std::size_t i,
                              float (&planes)[3][kCount]) {
  const hn::DFromV<V> d;
  const hn::Rebind<float, decltype(d)> single_d;
  const V inverse = hn::Div(hn::Set(d, 1.0), hn::Add(hn::Add(q0, q1), q2));
  const V w0 = hn::Mul(q0, inverse), w1 = hn::Mul(q1, inverse), w2 = hn::Mul(q2, inverse);
  if (!w.is_piece) {
    hn::StoreU(hn::DemoteTo(single_d, w0), single_d, planes[w.order[0]] + i);
    hn::StoreU(hn::DemoteTo(single_d, w1), single_d, planes[w.order[1]] + i);
    hn::StoreU(hn::DemoteTo(single_d, w2), single_d, planes[w.order[2]] + i);
    return;
  }
  for (std::size_t v = 0; v < 3; ++v) {
    const V weight = hn::Add(
        hn::Add(hn::Mul(hn::Set(d, w.piece[0][v]), w0), hn::Mul(hn::Set(d, w.piece[1][v]), w1)),
        hn::Mul(hn::Set(d, w.piece[2][v]), w2));
    hn::StoreU(hn::DemoteTo(single_d, weight), single_d, planes[v] + i);
  }
}

/// The weights of block b's pixels.
HWY_INLINE void block_weights(const TileWeights& w, std::size_t b, PixelMask mask,
                              float (&planes)[3][kPixels]) {
  const hn::CappedTag<double, kWidth> d;
  const auto x0 = static_cast<double>(b % 8 * 8), y0 = static_cast<double>(b / 8 * 8);
  const VectorRange range = vectors_of(d, mask);
  for (std::size_t i = range.first; i < range.end; i += hn::Lanes(d)) {
    if (!any_pixel(mask, i, hn::Lanes(d))) continue;
    const auto x = hn::Iota(d, x0 + static_cast<double>(i % kWidth));
    const double y = y0 + static_cast<double>(i / kWidth);
    const auto scaled_edge = [&](std::size_t k) HWY_ATTR {
      const auto first = hn::Set(d, w.edge[k] + y * w.step_y[k]);
      const auto edge = hn::Add(first, hn::Mul(x, hn::Set(d, w.step_x[k])));
      return hn::Mul(edge, hn::Set(d, w.scale[k]));
    };
    store_weights(w, scaled_edge(0), scaled_edge(1), scaled_edge(2), i, planes);
  }
}

HWY_INLINE VU32 to_unorm8(VF32 value) {
  const DF32 d;
  // NaN is not greater than 0.
  const VF32 positive = hn::IfThenElseZero(hn::Gt(value, hn::Zero(d)), value);
  const VF32 scaled = hn::Mul(hn::Min(positive, set(1.0f)), set(255.0f));
  return hn::BitCast(DU32(), hn::NearestInt(scaled));
}

HWY_INLINE VU32 to_rgba8(const Rgba& color) {
  return hn::Or(
      hn::Or(to_unorm8(color.rgb.x), hn::ShiftLeft<8>(to_unorm8(color.rgb.y))),
      hn::Or(hn::ShiftLeft<16>(to_unorm8(color.rgb.z)), hn::ShiftLeft<24>(to_unorm8(color.alpha))));
}

void store_colors(const float* colors, PixelMask mask, std::uint8_t* stored) noexcept {
  const DF32 d;
  const DU32 whole_d;
  auto* const to = reinterpret_cast<std::uint32_t*>(stored);
  const auto channel = [&](std::size_t c, std::size_t i)
                           HWY_ATTR { return hn::LoadU(d, colors + c * kPixels + i); };
  const VectorRange range = vectors_of(d, mask);
  for (std::size_t i = range.first; i < range.end; i += hn::Lanes(d)) {
    const Rgba color{{channel(0, i), channel(1, i), channel(2, i)}, channel(3, i)};
    hn::BlendedStore(to_rgba8(color), lanes_of(whole_d, mask, i), whole_d, to + i);
  }
}

/// A tile's RGBA8 pixels.
class Rgba8Pixels {
 public:
  HWY_INLINE explicit Rgba8Pixels(const ColorTile& tile)
      : pixels_(reinterpret_cast<std::uint32_t*>(tile.rgba8)), blend_(*tile.state, tile.constant) {}

  /// Writes a vector of pixels from the i-th on, of those in the mask.
  HWY_INLINE void write(std::size_t i, hn::Mask<DU32> here, const Rgba& color) const {
    const DU32 d;
    const VU32 source = to_rgba8(color);
    if (blend_.replaces()) {
      hn::BlendedStore(source, here, d, pixels_ + i);
      return;
    }
    const VU32 old = hn::LoadU(d, pixels_ + i);
    hn::StoreU(hn::IfThenElse(here, blend_.over(source, old), old), d, pixels_ + i);
  }

  /// Writes the pixels at these places, `count` of a vector.
  HWY_INLINE void write(const std::uint32_t* places, std::size_t count, const Rgba& color) const {
    const DU32 d;
    VU32 out = to_rgba8(color);
    if (!blend_.replaces())
      out = blend_.over(out, hn::GatherIndex(d, pixels_, hn::BitCast(DI32(), hn::Load(d, places))));
    alignas(64) std::uint32_t written[kPixels];
    hn::Store(out, d, written);
    for (std::size_t k = 0; k < count; ++k) pixels_[places[k]] = written[k];
  }

 private:
  std::uint32_t* const pixels_;
  const Rgba8Blend blend_;
};

/// A tile's RGBA32F pixels.
class Rgba32fPixels {
 public:
  HWY_INLINE explicit Rgba32fPixels(const ColorTile& tile)
      : pixels_(tile.rgba32f), state_(*tile.state) {}

  HWY_INLINE void write(std::size_t i, hn::Mask<DU32> here, const Rgba& color) const {
    const DF32 d;
    const auto mask = hn::RebindMask(d, here);
    Channels<DF32> old;
    hn::LoadInterleaved4(d, pixels_ + 4 * i, old.c[0], old.c[1], old.c[2], old.c[3]);
    const Channels<DF32> out = blend_floats(state_, channels(color), old);
    hn::StoreInterleaved4(hn::IfThenElse(mask, out.c[0], old.c[0]),
                          hn::IfThenElse(mask, out.c[1], old.c[1]),
                          hn::IfThenElse(mask, out.c[2], old.c[2]),
                          hn::IfThenElse(mask, out.c[3], old.c[3]), d, pixels_ + 4 * i);
  }

  HWY_INLINE void write(const std::uint32_t* places, std::size_t count, const Rgba& color) const {
    const DF32 d;
    const auto first = hn::ShiftLeft<2>(hn::BitCast(DI32(), hn::Load(DU32(), places)));
    Channels<DF32> old;
    for (std::size_t c = 0; c < 4; ++c) old.c[c] = hn::GatherIndex(d, pixels_ + c, first);
    const Channels<DF32> out = blend_floats(state_, channels(color), old);
    alignas(64) float written[4 * kPixels];
    hn::StoreInterleaved4(out.c[0], out.c[1], out.c[2], out.c[3], d, written);
    for (std::size_t k = 0; k < count; ++k)
      __builtin_memcpy(pixels_ + 4 * std::size_t{places[k]}, written + 4 * k, 16);
  }

 private:
  static HWY_INLINE Channels<DF32> channels(const Rgba& color) {
    return {{color.rgb.x, color.rgb.y, color.rgb.z, color.alpha}};
  }

  float* const pixels_;
  const ColorState& state_;
};

/// Pixels of a tile's blocks, side by side whatever rows and blocks they come from, so that a small
/// triangle fills few vectors.
struct PackedPixels {
  static constexpr std::size_t kMost = 2 * kPixels;

  std::size_t count = 0;
  /// 64 times the block's number, plus the pixel's in it. Room for the rest of a last vector.
  alignas(64) std::uint32_t place[kMost + kPixels];

  HWY_INLINE void add(std::size_t b, PixelMask mask) {
    for (; mask; mask &= mask - 1)
      place[count++] =
          static_cast<std::uint32_t>(b * kPixels + static_cast<std::size_t>(__builtin_ctzll(mask)));
  }
};

/// Whether to pack them: what it costs to take pixels from their places and back there is less than
/// what rows that are mostly empty cost.
HWY_INLINE bool worth_packing(PixelMask mask) {
  constexpr int kPixelsOfRow = 6;
  PixelMask rows = mask | mask >> 4;
  rows |= rows >> 2;
  rows = (rows | rows >> 1) & 0x0101010101010101u;
  return __builtin_popcountll(mask) <= kPixelsOfRow * __builtin_popcountll(rows);
}

/// Shades and stores the pixels and forgets them.
template <class Pixels>
HWY_INLINE void flush(const TileShading& s, PackedPixels& packed, const Pixels& pixels) {
  const hn::CappedTag<double, kWidth> d;
  const hn::Rebind<std::int32_t, decltype(d)> place_d;
  const DF32 single_d;
  const std::size_t count = packed.count, lanes = hn::Lanes(single_d);
  if (count == 0) return;
  // Pixels of a last vector that are not there do as the first one does.
  for (std::size_t i = count; i % lanes != 0; ++i) packed.place[i] = packed.place[0];
  alignas(64) float planes[3][PackedPixels::kMost + kPixels];
  const TileWeights& w = s.weights;
  const auto low = hn::Set(place_d, 7), high = hn::Set(place_d, 56);
  for (std::size_t i = 0; i < (count + lanes - 1) / lanes * lanes; i += hn::Lanes(d)) {
    const auto place = hn::LoadU(place_d, reinterpret_cast<const std::int32_t*>(packed.place) + i);
    const auto x =
        hn::PromoteTo(d, hn::Or(hn::And(hn::ShiftRight<3>(place), high), hn::And(place, low)));
    const auto y = hn::PromoteTo(
        d, hn::Or(hn::And(hn::ShiftRight<6>(place), high), hn::And(hn::ShiftRight<3>(place), low)));
    const auto scaled_edge = [&](std::size_t k) HWY_ATTR {
      const auto first = hn::Add(hn::Set(d, w.edge[k]), hn::Mul(y, hn::Set(d, w.step_y[k])));
      const auto edge = hn::Add(first, hn::Mul(x, hn::Set(d, w.step_x[k])));
      return hn::Mul(edge, hn::Set(d, w.scale[k]));
    };
    store_weights(w, scaled_edge(0), scaled_edge(1), scaled_edge(2), i, planes);
  }
  for (std::size_t i = 0; i < count; i += lanes) {
    const VF32 p0 = hn::Load(single_d, planes[0] + i), p1 = hn::Load(single_d, planes[1] + i),
               p2 = hn::Load(single_d, planes[2] + i);
    const VF32 share = share_of(s, p0, p1, p2);
    if (s.zero_share_keeps && hn::AllTrue(single_d, hn::Eq(share, hn::Zero(single_d)))) continue;
    pixels.write(packed.place + i, HWY_MIN(lanes, count - i), colors_of(s, p0, p1, p2, share));
  }
  packed.count = 0;
}

template <class Pixels>
HWY_INLINE void shade_block(const TileShading& s, std::size_t b, PixelMask mask,
                            const Pixels& pixels) {
  const DF32 d;
  const DU32 pixel_d;
  alignas(64) float planes[3][kPixels];
  if (hn::Lanes(d) > kWidth) {
    // A vector may have a row without a pixel, whose weights are not found.
    for (float& weight : planes[0]) weight = 0.0f;
    for (float& weight : planes[1]) weight = 0.0f;
    for (float& weight : planes[2]) weight = 0.0f;
  }
  block_weights(s.weights, b, mask, planes);
  const VectorRange range = vectors_of(d, mask);
  for (std::size_t i = range.first; i < range.end; i += hn::Lanes(d)) {
    if (!any_pixel(mask, i, hn::Lanes(d))) continue;
    const VF32 p0 = hn::Load(d, planes[0] + i), p1 = hn::Load(d, planes[1] + i),
               p2 = hn::Load(d, planes[2] + i);
    const auto here = lanes_of(pixel_d, mask, i);
    const VF32 share = share_of(s, p0, p1, p2);
    if (s.zero_share_keeps &&
        hn::AllFalse(d, hn::And(hn::RebindMask(d, here), hn::Ne(share, hn::Zero(d)))))
      continue;
    pixels.write(b * kPixels + i, here, colors_of(s, p0, p1, p2, share));
  }
}

template <class Pixels>
HWY_INLINE void shade_tile(const TileShading& s, BlockMask blocks, const PixelMask* masks,
                           const Pixels& pixels) {
  PackedPixels packed;
  for (BlockMask rest = blocks; rest; rest &= rest - 1) {
    const auto b = static_cast<std::size_t>(__builtin_ctzll(rest));
    if (worth_packing(masks[b])) {
      if (packed.count > PackedPixels::kMost - kPixels) flush(s, packed, pixels);
      packed.add(b, masks[b]);
      continue;
    }
    shade_block(s, b, masks[b], pixels);
  }
  flush(s, packed, pixels);
}

void shade_and_store(const TileShading& shading, BlockMask blocks, const PixelMask* masks,
                     const ColorTile& colors) noexcept {
  if (colors.rgba8)
    shade_tile(shading, blocks, masks, Rgba8Pixels(colors));
  else
    shade_tile(shading, blocks, masks, Rgba32fPixels(colors));
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
