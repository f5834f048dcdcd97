#include "raster/shading.h"

#include <algorithm>
#include <cmath>

namespace gnomon::raster {

namespace {

float dot3(const glm::vec3& a, const glm::vec3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

/// Zero stays zero.
glm::vec3 normalized(const glm::vec3& v) {
  const float length = std::sqrt(dot3(v, v));
  return length > 0.0f ? glm::vec3(v.x / length, v.y / length, v.z / length) : v;
}

/// base^exponent by repeated squaring; base in [0, 1].
float power(float base, int exponent) {
  float result = 1.0f;
  for (int n = exponent; n > 0; n >>= 1) {
    if (n & 1) result = result * base;
    base = base * base;
  }
  return result;
}

struct LightSum {
  glm::vec3 ambient{0.0f}, diffuse{0.0f}, specular{0.0f};
};

void add_light(const Light& light, const Lit& lit, const glm::vec3& normal, const glm::vec3& world,
               LightSum& sum) {
  glm::vec3 to_light(light.position);
  float strength = 1.0f;
  if (light.position.w != 0.0f) {
    to_light = to_light - world;
    const float distance = std::sqrt(dot3(to_light, to_light));
    const float attenuation = (light.attenuation.x + light.attenuation.y * distance) +
                              light.attenuation.z * (distance * distance);
    strength = attenuation > 0.0f ? 1.0f / attenuation : 0.0f;
  }
  to_light = normalized(to_light);
  if (light.spot_cos_cutoff > -1.0f) {
    const float cosine = -dot3(to_light, light.spot_direction);
    // A cone wider than a half space has negative cosines in it; they count as 0, as in
    // OpenGL's product of two vectors.
    strength = cosine < light.spot_cos_cutoff
                   ? 0.0f
                   : strength * power(std::max(cosine, 0.0f), light.spot_exponent);
  }
  sum.ambient = sum.ambient + light.ambient * strength;
  const float n_dot_l = dot3(normal, to_light);
  if (!(n_dot_l > 0.0f)) return;
  if (light.shadow_map)
    strength = strength * compare_depth(*light.shadow_map, glm::vec4(world, 1.0f));
  sum.diffuse = sum.diffuse + light.diffuse * (n_dot_l * strength);
  const glm::vec3 half_vector = normalized(to_light + normalized(lit.eye_world - world));
  const float n_dot_h = dot3(normal, half_vector);
  const float highlight = n_dot_h > 0.0f ? power(n_dot_h, lit.material.shininess) : 0.0f;
  sum.specular = sum.specular + light.specular * (highlight * strength);
}

glm::vec4 shade_flat(const Flat& flat, const Fragment& fragment) {
  glm::vec4 color = flat.color * fragment.color;
  if (flat.texture) color = color * sample(*flat.texture, fragment.texcoord.x, fragment.texcoord.y);
  if (flat.depth_lookup) {
    const float share = compare_depth(*flat.depth_lookup, fragment.model);
    const bool rgb = flat.depth_texture_mode != DepthTextureMode::alpha;
    const bool alpha = flat.depth_texture_mode != DepthTextureMode::luminance;
    color = color * glm::vec4(glm::vec3(rgb ? share : 1.0f), alpha ? share : 1.0f);
  }
  return color;
}

/// The lighting equation at a point whose ambient and diffuse terms `base` scales.
glm::vec4 lit_color(const Lit& lit, const Fragment& point, const glm::vec4& base) {
  glm::vec3 normal = normalized(point.normal);
  if (lit.two_sided && !point.front_facing) normal = -normal;

  LightSum sum;
  sum.ambient = lit.scene_ambient;
  for (const Light& light : lit.lights) add_light(light, lit, normal, point.world, sum);

  const Material& material = lit.material;
  glm::vec3 color(0.0f);
  if (lit.ambient) color = color + (material.ambient * sum.ambient) * glm::vec3(base);
  if (lit.diffuse) color = color + (material.diffuse * sum.diffuse) * glm::vec3(base);
  if (lit.specular) color = color + material.specular * sum.specular;
  if (lit.emission) color = color + material.emission;
  return {color, material.alpha * base.a};
}

glm::vec4 shade_lit(const Lit& lit, const Fragment& fragment) {
  glm::vec4 base = fragment.color;
  if (lit.texture) base = base * sample(*lit.texture, fragment.texcoord.x, fragment.texcoord.y);
  return lit.at_vertices ? base : lit_color(lit, fragment, base);
}

/// NaN is not greater than 0.
float clamped(float value) { return value > 0.0f ? std::min(value, 1.0f) : 0.0f; }

}  // namespace

glm::vec4 shade(const Shading& shading, const Fragment& fragment) {
  if (const Flat* flat = std::get_if<Flat>(&shading)) return shade_flat(*flat, fragment);
  return shade_lit(std::get<Lit>(shading), fragment);
}

glm::vec4 light_vertex(const Lit& lit, const Fragment& vertex) {
  const glm::vec4 color = lit_color(lit, vertex, vertex.color);
  return {clamped(color.r), clamped(color.g), clamped(color.b), clamped(color.a)};
}

}  // namespace gnomon::raster
