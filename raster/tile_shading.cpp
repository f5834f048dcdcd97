#include "raster/tile_shading.h"

#include <algorithm>
#include <cmath>

#include "raster/lookup_bounds.h"

namespace gnomon::raster {

namespace {

template <class Vector, std::size_t kCount>
void copy(const Vector& from, float (&to)[kCount]) {
  for (std::size_t i = 0; i < kCount; ++i) to[i] = from[static_cast<int>(i)];
}

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

FlatLookup make_flat_lookup(const Draw& draw, const Flat& flat, ColorFormat format,
                            const Kernels& kernels, std::pmr::memory_resource& memory) {
  FlatLookup out{.terms = make_lookup(*flat.depth_lookup),
                 .ranges = std::pmr::vector<LookupRange>(&memory)};
  out.scales_rgb = flat.depth_texture_mode != DepthTextureMode::alpha;
  out.scales_alpha = flat.depth_texture_mode != DepthTextureMode::luminance;
  out.zero_keeps = zero_keeps(draw, flat, format);
  out.is_rgba8 = format == ColorFormat::rgba8;
  if (out.zero_keeps && kernels.lookup_fails)
    out.ranges = lookup_ranges(draw, *flat.depth_lookup, kernels, memory);
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

}  // namespace

std::optional<DrawShading> make_draw_shading(const Draw& draw, const Targets& targets,
                                             const Kernels& kernels,
                                             std::pmr::memory_resource& memory) {
  if (const Flat* flat = std::get_if<Flat>(&draw.shading)) {
    if (flat->texture) return std::nullopt;
    DrawShading shading{.lights = std::pmr::vector<LitLight>(&memory)};
    if (flat->depth_lookup)
      shading.lookup = make_flat_lookup(draw, *flat, targets.color->format(), kernels, memory);
    return shading;
  }
  const Lit& lit = std::get<Lit>(draw.shading);
  if (lit.texture) return std::nullopt;
  DrawShading shading{.lights = std::pmr::vector<LitLight>(&memory)};
  for (const Light& light : lit.lights) shading.lights.push_back(make_light(light));
  shading.lit = make_lit(lit);
  shading.two_sided = lit.two_sided;
  return shading;
}

bool FlatLookup::leaves_no_mark(const Kernels& kernels, const glm::vec4* positions,
                                const std::uint32_t* index, int count) const {
  if (ranges.empty()) return false;
  const LookupBounds bounds{&terms, ranges.data(), (terms.width + kBlockSize - 1) / kBlockSize};
  return kernels.lookup_fails(bounds, positions, index, count);
}

TileShading make_tile_shading(const Draw& draw, const DrawShading& shading,
                              const SetupTriangle& triangle, const TriangleSource& source, int x,
                              int y) {
  TileShading out;
  TileWeights& weights = out.weights;
  const double area = static_cast<double>(triangle.area());
  const std::array<double, 3> inverse_w = source.inverse_w(triangle, draw.mesh.indices);
  weights.is_piece = triangle.piece != SetupTriangle::kWhole;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Edge edge = triangle.edge(k);
    weights.edge[i] =
        static_cast<double>(edge.at(x * std::int64_t{256} + 128, y * std::int64_t{256} + 128));
    weights.step_x[i] = 256.0 * edge.a;
    weights.step_y[i] = 256.0 * edge.b;
    weights.scale[i] = inverse_w[i] / area;
    weights.order[i] = triangle.swapped && k > 0 ? 3 - k : k;
    if (weights.is_piece)
      for (int v = 0; v < 3; ++v)
        weights.piece[i][static_cast<std::size_t>(v)] = source.pieces[triangle.piece].weights[i][v];
  }
  out.lit = shading.lit ? &*shading.lit : nullptr;
  out.lights = shading.lights.data();
  out.light_count = static_cast<int>(shading.lights.size());
  if (const Flat* flat = std::get_if<Flat>(&draw.shading)) copy(flat->color, out.flat_color);
  if (const auto& lookup = shading.lookup) {
    out.lookup = &lookup->terms;
    out.lookup_scales_rgb = lookup->scales_rgb;
    out.lookup_scales_alpha = lookup->scales_alpha;
    // A piece's weights may be a little below 0.
    out.zero_share_keeps =
        lookup->zero_keeps && (lookup->is_rgba8 || triangle.piece == SetupTriangle::kWhole);
  } else {
    out.lookup = nullptr;
  }
  const MeshView& mesh = draw.mesh;
  out.has_colors = !mesh.colors.empty();
  out.reverse_normal = shading.two_sided && !triangle.front_facing;
  for (std::size_t v = 0; v < 3; ++v) {
    const std::uint32_t index = mesh.indices[triangle.first_index + v];
    if (out.has_colors) copy(mesh.colors[index], out.colors[v]);
    if (out.lit) copy(mesh.normals[index], out.normals[v]);
    if (out.lit || out.lookup) copy(mesh.positions[index], out.positions[v]);
  }
  return out;
}

}  // namespace gnomon::raster
