#include "raster/tile_shading.h"

#include "raster/lit_terms.h"
#include "raster/lookup_bounds.h"

namespace gnomon::raster {

namespace {

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
  // What is lit at vertices is flat here: 1 times the vertices' colours.
  if (lit.at_vertices) return shading;
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
  out.lighting = {shading.lit ? &*shading.lit : nullptr, shading.lights.data(),
                  static_cast<int>(shading.lights.size())};
  const Flat* const flat = std::get_if<Flat>(&draw.shading);
  copy(flat ? flat->color : glm::vec4(1.0f), out.flat_color);
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
  const std::span<const glm::vec4> colors = source.colors.of(triangle.front_facing);
  out.has_colors = !colors.empty();
  out.reverse_normal = shading.two_sided && !triangle.front_facing;
  for (std::size_t v = 0; v < 3; ++v) {
    const std::uint32_t index = mesh.indices[triangle.first_index + v];
    if (out.has_colors) copy(colors[index], out.colors[v]);
    if (shading.lit) copy(mesh.normals[index], out.normals[v]);
    if (shading.lit || out.lookup) copy(mesh.positions[index], out.positions[v]);
  }
  return out;
}

}  // namespace gnomon::raster
