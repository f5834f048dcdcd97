// Vector kernels: colours of pixels, and the lighting equation. The same operations in the same
// order as raster/interpolate.cpp and raster/shading.cpp, products and sums apart, each rounded
// once. Read once for each instruction set, so its guard goes to and fro with Highway's.
#if defined(GNOMON_RASTER_SHADE_COLORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef GNOMON_RASTER_SHADE_COLORS_INL_H
#undef GNOMON_RASTER_SHADE_COLORS_INL_H
#else
#define GNOMON_RASTER_SHADE_COLORS_INL_H
#endif

#include <limits>

#include <hwy/highway.h>

#include "raster/depth_lookup-inl.h"
#include "raster/kernels.h"
#include "raster/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gnomon::raster {
namespace HWY_NAMESPACE {

struct Vector3 {
  VF32 x, y, z;
};

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
  if (light.has_shadow_map && !hn::AllFalse(d, faces))
    strength =
        hn::Mul(strength, compare_depth(light.shadow_map, world.x, world.y, world.z, set(1.0f)));
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

/// A unit normal in the world.
HWY_INLINE Vector3 world_normal(const LitTerms& lit, const Vector3& n) {
  const auto row = [&](std::size_t r) HWY_ATTR {
    const auto& m = lit.world_from_model_normal;
    return hn::Add(hn::Add(hn::Mul(set(m[0][r]), n.x), hn::Mul(set(m[1][r]), n.y)),
                   hn::Mul(set(m[2][r]), n.z));
  };
  return normalized({row(0), row(1), row(2)});
}

HWY_INLINE Vector3 world_position(const LitTerms& lit, VF32 x, VF32 y, VF32 z, VF32 w) {
  const auto row = [&](std::size_t r) HWY_ATTR {
    const auto& m = lit.world_from_model;
    return hn::Add(hn::Add(hn::Mul(set(m[0][r]), x), hn::Mul(set(m[1][r]), y)),
                   hn::Add(hn::Mul(set(m[2][r]), z), hn::Mul(set(m[3][r]), w)));
  };
  return {row(0), row(1), row(2)};
}

HWY_INLINE Vector3 reversed(const Vector3& v) { return {hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)}; }

/// The lighting equation's colours without alpha, of fragments or of vertices; `base`, the mesh's
/// colours, is 1 and left out unless `has_base`.
HWY_INLINE Vector3 lit_color(const Lighting& lighting, const Vector3& normal, const Vector3& world,
                             bool has_base, const Vector3& base) {
  const LitTerms& lit = *lighting.terms;
  const VF32 zero = hn::Zero(DF32());
  LightSums sums{set(lit.scene_ambient), {zero, zero, zero}, {zero, zero, zero}};
  for (int i = 0; i < lighting.light_count; ++i)
    add_light(lighting.lights[i], lit, normal, world, sums);
  Vector3 color{zero, zero, zero};
  const auto tinted = [&](const Vector3& v) HWY_ATTR { return has_base ? mul(v, base) : v; };
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

/// The lit colours of fragments; `base` and `alpha` are the mesh's.
HWY_INLINE Rgba lit_fragments(const TileShading& s, VF32 p0, VF32 p1, VF32 p2, const Vector3& base,
                              VF32 alpha) {
  const LitTerms& lit = *s.lighting.terms;
  const auto n = [&](std::size_t c) HWY_ATTR {
    return weighted(s.normals[0][c], s.normals[1][c], s.normals[2][c], p0, p1, p2);
  };
  const auto p = [&](std::size_t c) HWY_ATTR {
    return weighted(s.positions[0][c], s.positions[1][c], s.positions[2][c], p0, p1, p2);
  };
  Vector3 normal = world_normal(lit, {n(0), n(1), n(2)});
  if (s.reverse_normal) normal = reversed(normal);
  const VF32 zero = hn::Zero(DF32());
  Vector3 world{zero, zero, zero};
  if (lit.world_matters) world = world_position(lit, p(0), p(1), p(2), p(3));
  return {lit_color(s.lighting, normal, world, s.has_colors, base),
          hn::Mul(set(lit.material_alpha), alpha)};
}

/// The share that the flat colour's lookup gives; 1 if there is none.
HWY_INLINE VF32 share_of(const TileShading& s, VF32 p0, VF32 p1, VF32 p2) {
  if (!s.lookup) return set(1.0f);
  const auto p = [&](std::size_t c) HWY_ATTR {
    return weighted(s.positions[0][c], s.positions[1][c], s.positions[2][c], p0, p1, p2);
  };
  return compare_depth(*s.lookup, p(0), p(1), p(2), p(3));
}

/// The colours of as many pixels as there are lanes, from their weights and their shares.
HWY_INLINE Rgba colors_of(const TileShading& s, VF32 p0, VF32 p1, VF32 p2, VF32 share) {
  const auto base = [&](std::size_t c) HWY_ATTR {
    return s.has_colors ? weighted(s.colors[0][c], s.colors[1][c], s.colors[2][c], p0, p1, p2)
                        : set(1.0f);
  };
  const Vector3 rgb{base(0), base(1), base(2)};
  const VF32 alpha = base(3);
  if (s.lighting.terms) return lit_fragments(s, p0, p1, p2, rgb, alpha);
  Rgba color{mul({set(s.flat_color[0]), set(s.flat_color[1]), set(s.flat_color[2])}, rgb),
             hn::Mul(set(s.flat_color[3]), alpha)};
  if (s.lookup && s.lookup_scales_rgb) color.rgb = scaled(color.rgb, share);
  if (s.lookup && s.lookup_scales_alpha) color.alpha = hn::Mul(color.alpha, share);
  return color;
}

}  // namespace HWY_NAMESPACE
}  // namespace gnomon::raster
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
