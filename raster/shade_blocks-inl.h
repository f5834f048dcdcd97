// Vector kernels: colours of a block's pixels. The same operations in the same order as
// raster/interpolate.cpp and raster/shading.cpp, products and sums apart, each rounded once.
// Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_SHADE_BLOCKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_SHADE_BLOCKS_INL_H
#undef GNOMON_RASTER_SHADE_BLOCKS_INL_H
#else
#define GNOMON_RASTER_SHADE_BLOCKS_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

using DF32 = hn::CappedTag<float, kPixels>;
using VF32 = hn::Vec<DF32>;

struct Vector3 {
  VF32 x, y, z;
};

HWY_INLINE VF32 set(float value) { return hn::Set(DF32(), value); }
HWY_INLINE Vector3 set(const float (&v)[3]) { return {set(v[0]), set(v[1]), set(v[2])}; }
HWY_INLINE Vector3 add(const Vector3& a, const Vector3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector3 sub(const Vector3& a, const Vector3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vector3 mul(const Vector3& a, const Vector3& b) {
  return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
HWY_INLINE Vector3 scaled(const Vector3& v, VF32 s) {
  return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)};
}
HWY_INLINE VF32 dot3(const Vector3& a, const Vector3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector3 where(hn::Mask<DF32> mask, const Vector3& yes, const Vector3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

/// v over its length; zero stays zero.
HWY_INLINE Vector3 over_length(const Vector3& v, VF32 length) {
  const Vector3 unit{hn::Div(v.x, length), hn::Div(v.y, length), hn::Div(v.z, length)};
  return where(hn::Gt(length, hn::Zero(DF32())), unit, v);
}

HWY_INLINE Vector3 normalized(const Vector3& v) { return over_length(v, hn::Sqrt(dot3(v, v))); }

HWY_INLINE VF32 power(VF32 base, int exponent) {
  VF32 result = set(1.0f);
  for (int n = exponent; n > 0; n >>= 1) {
    if (n & 1) result = hn::Mul(result, base);
    base = hn::Mul(base, base);
  }
  return result;
}

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

/// A component of an attribute from its values at the three vertices.
HWY_INLINE VF32 weighted(float a, float b, float c, VF32 p0, VF32 p1, VF32 p2) {
  return hn::Add(hn::Add(hn::Mul(set(a), p0), hn::Mul(set(b), p1)), hn::Mul(set(c), p2));
}

struct LightSums {
  Vector3 ambient, diffuse, specular;
};

HWY_INLINE void add_light(const LitLight& light, const LitTerms& lit, const Vector3& normal,
                          const Vector3& world, LightSums& sums) {
  const DF32 d;
  const VF32 zero = hn::Zero(d);
  Vector3 to_light{set(light.position[0]), set(light.position[1]), set(light.position[2])};
  VF32 strength = set(1.0f);
  const bool is_point = light.position[3] != 0.0f;
  if (is_point) to_light = sub(to_light, world);
  const VF32 distance = hn::Sqrt(dot3(to_light, to_light));
  if (is_point && light.keeps_strength) {
    // The quotient below is 1 unless the square overflows or is NaN; it is 0 then.
    const VF32 infinity = set(std::numeric_limits<float>::infinity());
    strength = hn::IfThenElseZero(hn::Lt(hn::Mul(distance, distance), infinity), strength);
  } else if (is_point) {
    const VF32 attenuation =
        hn::Add(hn::Add(set(light.attenuation[0]), hn::Mul(set(light.attenuation[1]), distance)),
                hn::Mul(set(light.attenuation[2]), hn::Mul(distance, distance)));
    strength = hn::IfThenElseZero(hn::Gt(attenuation, zero), hn::Div(set(1.0f), attenuation));
  }
  to_light = over_length(to_light, distance);
  if (light.spot_cos_cutoff > -1.0f) {
    const VF32 cosine = hn::Neg(dot3(to_light, set(light.spot_direction)));
    const VF32 positive = hn::IfThenZeroElse(hn::Lt(cosine, zero), cosine);
    strength = hn::IfThenZeroElse(hn::Lt(cosine, set(light.spot_cos_cutoff)),
                                  hn::Mul(strength, power(positive, light.spot_exponent)));
  }
  if (light.ambient_matters) sums.ambient = add(sums.ambient, scaled(set(light.ambient), strength));
  const VF32 n_dot_l = dot3(normal, to_light);
  const auto faces = hn::Gt(n_dot_l, zero);
  sums.diffuse =
      where(faces, add(sums.diffuse, scaled(set(light.diffuse), hn::Mul(n_dot_l, strength))),
            sums.diffuse);
  if (!lit.specular_matters) return;
  const Vector3 half_vector = normalized(add(to_light, normalized(sub(set(lit.eye_world), world))));
  const VF32 n_dot_h = dot3(normal, half_vector);
  const VF32 highlight = hn::IfThenElseZero(hn::Gt(n_dot_h, zero), power(n_dot_h, lit.shininess));
  sums.specular =
      where(faces, add(sums.specular, scaled(set(light.specular), hn::Mul(highlight, strength))),
            sums.specular);
}

HWY_INLINE Vector3 world_normal(const TileShading& s, VF32 p0, VF32 p1, VF32 p2) {
  const auto n = [&](std::size_t c) HWY_ATTR {
    return weighted(s.normals[0][c], s.normals[1][c], s.normals[2][c], p0, p1, p2);
  };
  const VF32 x = n(0), y = n(1), z = n(2);
  const auto row = [&](std::size_t r) HWY_ATTR {
    const auto& m = s.lit->world_from_model_normal;
    return hn::Add(hn::Add(hn::Mul(set(m[0][r]), x), hn::Mul(set(m[1][r]), y)),
                   hn::Mul(set(m[2][r]), z));
  };
  return {row(0), row(1), row(2)};
}

HWY_INLINE Vector3 world_position(const TileShading& s, VF32 p0, VF32 p1, VF32 p2) {
  const auto p = [&](std::size_t c) HWY_ATTR {
    return weighted(s.positions[0][c], s.positions[1][c], s.positions[2][c], p0, p1, p2);
  };
  const VF32 x = p(0), y = p(1), z = p(2), w = p(3);
  const auto row = [&](std::size_t r) HWY_ATTR {
    const auto& m = s.lit->world_from_model;
    return hn::Add(hn::Add(hn::Mul(set(m[0][r]), x), hn::Mul(set(m[1][r]), y)),
                   hn::Add(hn::Mul(set(m[2][r]), z), hn::Mul(set(m[3][r]), w)));
  };
  return {row(0), row(1), row(2)};
}

/// The lit colour without alpha; `base` is the mesh's colour.
HWY_INLINE Vector3 lit_color(const TileShading& s, VF32 p0, VF32 p1, VF32 p2, const Vector3& base) {
  const LitTerms& lit = *s.lit;
  const VF32 zero = hn::Zero(DF32());
  Vector3 normal = normalized(world_normal(s, p0, p1, p2));
  if (s.reverse_normal) normal = {hn::Neg(normal.x), hn::Neg(normal.y), hn::Neg(normal.z)};
  Vector3 world{zero, zero, zero};
  if (lit.world_matters) world = world_position(s, p0, p1, p2);
  LightSums sums{set(lit.scene_ambient), {zero, zero, zero}, {zero, zero, zero}};
  for (int i = 0; i < s.light_count; ++i) add_light(s.lights[i], lit, normal, world, sums);
  Vector3 color{zero, zero, zero};
  // Without colours the base is 1.
  const auto tinted = [&](const Vector3& v) HWY_ATTR { return s.has_colors ? mul(v, base) : v; };
  if (lit.ambient) color = add(color, tinted(mul(set(lit.material_ambient), sums.ambient)));
  if (lit.diffuse) color = add(color, tinted(mul(set(lit.material_diffuse), sums.diffuse)));
  if (lit.specular && lit.specular_matters)
    color = add(color, mul(set(lit.material_specular), sums.specular));
  if (lit.emission) color = add(color, set(lit.material_emission));
  return color;
}

struct Rgba {
  Vector3 rgb;
  VF32 alpha;
};

/// The colours of as many pixels as there are lanes, from their weights.
HWY_INLINE Rgba colors_of(const TileShading& s, VF32 p0, VF32 p1, VF32 p2) {
  const auto base = [&](std::size_t c) HWY_ATTR {
    return s.has_colors ? weighted(s.colors[0][c], s.colors[1][c], s.colors[2][c], p0, p1, p2)
                        : set(1.0f);
  };
  const Vector3 rgb{base(0), base(1), base(2)};
  const VF32 alpha = base(3);
  const Vector3 color =
      s.lit ? lit_color(s, p0, p1, p2, rgb)
            : mul({set(s.flat_color[0]), set(s.flat_color[1]), set(s.flat_color[2])}, rgb);
  return {color, hn::Mul(set(s.lit ? s.lit->material_alpha : s.flat_color[3]), alpha)};
}

void shade_block(const TileShading& s, std::size_t b, PixelMask mask, float* colors) noexcept {
  const DF32 d;
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
    const Rgba color = colors_of(s, hn::Load(d, planes[0] + i), hn::Load(d, planes[1] + i),
                                 hn::Load(d, planes[2] + i));
    hn::StoreU(color.rgb.x, d, colors + i);
    hn::StoreU(color.rgb.y, d, colors + kPixels + i);
    hn::StoreU(color.rgb.z, d, colors + 2 * kPixels + i);
    hn::StoreU(color.alpha, d, colors + 3 * kPixels + i);
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
HWY_INLINE void flush(const TileShading& s, PackedPixels& pixels, std::uint32_t* stored) {
  const hn::CappedTag<double, kWidth> d;
  const hn::Rebind<std::int32_t, decltype(d)> place_d;
  const DF32 single_d;
  const std::size_t count = pixels.count, lanes = hn::Lanes(single_d);
  if (count == 0) return;
  // Pixels of a last vector that are not there do as the first one does.
  for (std::size_t i = count; i % lanes != 0; ++i) pixels.place[i] = pixels.place[0];
  alignas(64) float planes[3][PackedPixels::kMost + kPixels];
  const TileWeights& w = s.weights;
  const auto low = hn::Set(place_d, 7), high = hn::Set(place_d, 56);
  for (std::size_t i = 0; i < (count + lanes - 1) / lanes * lanes; i += hn::Lanes(d)) {
    const auto place = hn::LoadU(place_d, reinterpret_cast<const std::int32_t*>(pixels.place) + i);
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
  alignas(64) std::uint32_t colors[kPixels];
  for (std::size_t i = 0; i < count; i += lanes) {
    const Rgba color =
        colors_of(s, hn::Load(single_d, planes[0] + i), hn::Load(single_d, planes[1] + i),
                  hn::Load(single_d, planes[2] + i));
    hn::Store(to_rgba8(color), DU32(), colors);
    for (std::size_t k = 0; k < lanes && i + k < count; ++k)
      stored[pixels.place[i + k]] = colors[k];
  }
  pixels.count = 0;
}

void shade_and_store(const TileShading& shading, BlockMask blocks, const PixelMask* masks,
                     std::uint8_t* stored) noexcept {
  alignas(64) float colors[4 * kPixels];
  auto* const packed_to = reinterpret_cast<std::uint32_t*>(stored);
  PackedPixels packed;
  for (BlockMask rest = blocks; rest; rest &= rest - 1) {
    const auto b = static_cast<std::size_t>(__builtin_ctzll(rest));
    if (worth_packing(masks[b])) {
      if (packed.count > PackedPixels::kMost - kPixels) flush(shading, packed, packed_to);
      packed.add(b, masks[b]);
      continue;
    }
    shade_block(shading, b, masks[b], colors);
    store_colors(colors, masks[b], stored + b * kPixels * 4);
  }
  flush(shading, packed, packed_to);
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
