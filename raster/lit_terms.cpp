#include "raster/lit_terms.h"

#include <algorithm>
#include <cmath>

namespace gnomon::raster {

namespace {

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The light's specular sum is finite whatever the fragment is: its strength is at most
/// 1 / attenuation.x, and a power of a cosine, which rounding may leave a few 2^-24 above 1, stays
/// small up to this exponent.
bool has_finite_specular(const Light& light, int shininess) {
  constexpr int kLargestExponent = 1 << 20;
  const glm::vec3& attenuation = light.attenuation;
  return finite(light.specular) && shininess <= kLargestExponent &&
         light.spot_exponent <= kLargestExponent && attenuation.x >= 1e-6f &&
         attenuation.y >= 0.0f && attenuation.z >= 0.0f;
}

/// Adding zero times a finite sum changes no bit of a colour.
bool specular_matters(const Lit& lit) {
  if (!lit.specular) return false;
  if (lit.material.specular != glm::vec3(0.0f)) return true;
  for (const Light& light : lit.lights)
    if (!has_finite_specular(light, lit.material.shininess)) return true;
  return false;
}

}  // namespace

LookupTerms make_lookup(const DepthLookup& lookup) {
  LookupTerms out{};
  for (int c = 0; c < 4; ++c)
    copy(lookup.map_from_position[c], out.map_from_position[static_cast<std::size_t>(c)]);
  const TiledPlane<std::uint32_t>& texels = lookup.map->plane();
  out.texels = texels.tile(0, 0);
  out.width = texels.width();
  out.height = texels.height();
  out.tiles_x = texels.tiles_x();
  out.units = static_cast<float>(lookup.map->max_value() + 1);
  out.func = lookup.func;
  out.linear = lookup.filter == Filter::linear;
  out.has_border = lookup.border.has_value();
  const float border = lookup.border.value_or(0.0f);
  out.border = std::isnan(border) ? 0.0f : std::clamp(border, 0.0f, 1.0f);
  return out;
}

LitLight make_light(const Light& light) {
  LitLight out{};
  copy(light.position, out.position);
  copy(light.ambient, out.ambient);
  copy(light.diffuse, out.diffuse);
  copy(light.specular, out.specular);
  copy(light.attenuation, out.attenuation);
  out.keeps_strength = light.attenuation == glm::vec3(1.0f, 0.0f, 0.0f);
  copy(light.spot_direction, out.spot_direction);
  out.spot_cos_cutoff = light.spot_cos_cutoff;
  out.spot_exponent = light.spot_exponent;
  out.has_shadow_map = light.shadow_map.has_value();
  if (light.shadow_map) out.shadow_map = make_lookup(*light.shadow_map);
  // The strength is 0 or 1 then, and 0 times it is 0.
  const bool finite_strength =
      (light.position.w == 0.0f || out.keeps_strength) && light.spot_cos_cutoff <= -1.0f;
  out.ambient_matters = light.ambient != glm::vec3(0.0f) || !finite_strength;
  return out;
}

LitTerms make_lit(const Lit& lit) {
  LitTerms out{};
  copy(lit.material.ambient, out.material_ambient);
  copy(lit.material.diffuse, out.material_diffuse);
  copy(lit.material.specular, out.material_specular);
  copy(lit.material.emission, out.material_emission);
  out.material_alpha = lit.material.alpha;
  out.shininess = lit.material.shininess;
  out.ambient = lit.ambient;
  // A colour that 0 is added to stays: it is never -0, because it began as 0.
  out.emission = lit.emission && lit.material.emission != glm::vec3(0.0f);
  out.diffuse = lit.diffuse;
  out.specular = lit.specular;
  out.specular_matters = specular_matters(lit);
  out.world_matters = out.specular_matters;
  for (const Light& light : lit.lights)
    out.world_matters = out.world_matters || light.position.w != 0.0f || light.shadow_map;
  copy(lit.scene_ambient, out.scene_ambient);
  copy(lit.eye_world, out.eye_world);
  for (int c = 0; c < 4; ++c)
    copy(lit.world_from_model[c], out.world_from_model[static_cast<std::size_t>(c)]);
  for (int c = 0; c < 3; ++c)
    copy(lit.world_from_model_normal[c], out.world_from_model_normal[static_cast<std::size_t>(c)]);
  return out;
}

}  // namespace gnomon::raster
