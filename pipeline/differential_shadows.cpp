#include "pipeline/differential_shadows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/intensity_transfer.h"
#include "pipeline/map_plan.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// How much wider than the casters a view is: texels on its edge stay empty.
constexpr double kMargin = 0.02;

struct Cast {
  LightView view;
  Rectangle casters;
  double near_m, far_m;
};

glm::dvec3 middle_of(const ShadowCaster& caster) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : caster.corners) sum += p;
  return sum / 8.0;
}

/// The radiance of the casters' sides that are turned away from a point, a mean over the casters.
glm::dvec3 averted_light(const glm::dvec3& point, std::span<const ShadowCaster> casters,
                         const IrradianceVolume& light) {
  glm::dvec3 sum(0.0);
  for (const ShadowCaster& caster : casters) {
    const glm::dvec3 middle = middle_of(caster);
    const double distance = glm::length(middle - point);
    if (!(distance > 0.0)) continue;
    sum += caster.reflectance * light.irradiance(middle, (middle - point) / distance);
  }
  return sum / (std::numbers::pi * static_cast<double>(casters.size()));
}

/// The view from a patch to the casters; absent if one map cannot have it.
std::optional<Cast> cast_from(const glm::dvec3& light, std::span<const ShadowCaster> casters) {
  glm::dvec3 middle(0.0);
  for (const ShadowCaster& caster : casters)
    middle += middle_of(caster) / static_cast<double>(casters.size());
  const Light point{.position = glm::vec4(glm::vec3(light), 1.0f)};
  if (!(glm::length(middle - light) > 0.0)) return std::nullopt;
  Cast cast{LightView::towards(point, middle), {}, 0.0, 0.0};
  for (const ShadowCaster& caster : casters) {
    for (const glm::dvec3& p : caster.corners) {
      const glm::dvec3 local = cast.view.local(p);
      if (!(local.z > 0.0)) return std::nullopt;
      const glm::dvec2 place = cast.view.place(local);
      if (std::max(std::abs(place.x), std::abs(place.y)) > kWidestMap) return std::nullopt;
      cast.casters.add(place);
      cast.near_m = cast.near_m == 0.0 ? local.z : std::min(cast.near_m, local.z);
      cast.far_m = std::max(cast.far_m, local.z);
    }
  }
  const glm::dvec2 margin = cast.casters.extent() * kMargin;
  cast.casters.low -= margin;
  cast.casters.high += margin;
  const double depth = cast.far_m - cast.near_m;
  cast.near_m = std::max(cast.near_m * 0.5, cast.near_m - 0.05 * depth);
  cast.far_m += 0.05 * depth;
  if (cast.casters.empty() || !(cast.near_m < cast.far_m)) return std::nullopt;
  return cast;
}

/// The occluded rows below a node.
void take_rows(const LightPaths& paths, const OccludedLight& occluded, std::uint32_t node,
               std::vector<std::uint32_t>& rows) {
  const PatchNode& at = paths.sources.nodes[node];
  if (at.leaf()) {
    rows.push_back(paths.sources.order[at.first]);
    return;
  }
  for (const std::uint32_t child : at.children) {
    if (child != PatchNode::kNone && occluded.affects(child))
      take_rows(paths, occluded, child, rows);
  }
}

/// The receivers' own numbering of their vertices.
struct Receivers {
  /// Numbers in the model, ascending.
  std::vector<std::uint32_t> vertices;
  /// Three a patch.
  std::vector<std::uint32_t> indices;
};

Receivers number_receivers(const PatchModel& model, std::span<const std::uint32_t> patches) {
  constexpr std::uint32_t kUnused = 0xffffffff;
  std::vector<std::uint32_t> local(model.vertices.size(), kUnused);
  Receivers receivers;
  for (const std::uint32_t patch : patches) {
    for (const std::uint32_t v : model.patches[patch].vertices) local[v] = 0;
  }
  for (std::uint32_t v = 0; v < local.size(); ++v) {
    if (local[v] == kUnused) continue;
    local[v] = static_cast<std::uint32_t>(receivers.vertices.size());
    receivers.vertices.push_back(v);
  }
  receivers.indices.reserve(3 * patches.size());
  for (const std::uint32_t patch : patches) {
    for (const std::uint32_t v : model.patches[patch].vertices)
      receivers.indices.push_back(local[v]);
  }
  return receivers;
}

/// Fills what one shadow's sources give each of the receivers' vertices.
class Takes {
 public:
  Takes(const LitScene& scene, const LightPaths& paths, const Receivers& receivers,
        const OccludedLight& occluded, std::span<const ShadowCaster> casters,
        const IrradianceVolume& light, const ShadowTakeOptions& options,
        std::vector<SourceShadow>& shadows)
      : scene_(scene), paths_(paths), receivers_(receivers), options_(options), shadows_(shadows) {
    std::vector<std::uint32_t> rows;
    for (SourceShadow& shadow : shadows) {
      rows.clear();
      if (options.whole_clusters) {
        const auto items = paths.sources.items(paths.sources.nodes[shadow.cluster.node]);
        rows.assign(items.begin(), items.end());
      } else {
        take_rows(paths, occluded, shadow.cluster.node, rows);
      }
      const glm::dvec3 returned = options.returned_light
                                      ? averted_light(glm::dvec3(shadow.light), casters, light)
                                      : glm::dvec3(0.0);
      std::vector<Given>& given = given_.emplace_back();
      glm::dvec3 intensity(0.0);
      for (const std::uint32_t row : rows) {
        const std::uint32_t patch = paths.transfers.sources[row];
        const glm::dvec3 radiance(scene.radiance[patch]);
        intensity += radiance * scene.model.patches[patch].area_m2;
        given.push_back({paths.transfers.row(row).data(), kept_share(radiance, returned)});
      }
      shadow.intensity = glm::vec3(intensity);
      shadow.colors.resize(receivers.vertices.size());
      shadow.given.resize(receivers.vertices.size());
      first_set_.push_back(in_first_set(shadow.cluster.brightest, options.first_share) ? 1 : 0);
    }
  }

  void run() {
    constexpr std::size_t kChunk = 32;
    raster::for_each_chunk(receivers_.vertices.size(), kChunk, options_.threads,
                           [&](std::size_t first, std::size_t last) { fill(first, last); });
  }

 private:
  void fill(std::size_t first, std::size_t last) {
    std::vector<glm::vec3> transfers(shadows_.size()), values(shadows_.size());
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t vertex = receivers_.vertices[i];
      for (std::size_t j = 0; j < shadows_.size(); ++j) {
        transfers[j] = given(j, vertex);
        shadows_[j].given[i] = transfers[j] == glm::vec3(0.0f) ? 0 : 1;
      }
      const glm::dvec3 light(paths_.vertex_radiance[vertex]);
      if (options_.by_share) {
        for (std::size_t j = 0; j < shadows_.size(); ++j)
          shadows_[j].colors[i] = glm::vec4(share(transfers[j], light) + dither(j), 0.0f);
        continue;
      }
      if (options_.precision == ShadowPrecision::radiance) {
        values = transfers;
      } else {
        intensity_transfers(scene_.tone, light, transfers, first_set_, values);
        for (glm::vec3& value : values) value /= 255.0f;
      }
      for (std::size_t j = 0; j < shadows_.size(); ++j)
        shadows_[j].colors[i] = glm::vec4(values[j] + dither(j), 0.0f);
    }
  }

  /// At most all of it, and 0 where there is nothing to take a share of.
  static glm::vec3 share(const glm::vec3& taken, const glm::dvec3& whole) {
    glm::vec3 result(0.0f);
    for (int c = 0; c < 3; ++c)
      if (whole[c] > 0.0)
        result[c] = static_cast<float>(std::min(static_cast<double>(taken[c]) / whole[c], 1.0));
    return result;
  }

  /// One source's row of the transfers, and the share of it that an object in the way takes.
  struct Given {
    const glm::vec3* row;
    glm::vec3 share;
  };

  /// Not below 0: where an object is brighter than what it hides, its shadow takes nothing.
  static glm::vec3 kept_share(const glm::dvec3& radiance, const glm::dvec3& returned) {
    glm::dvec3 share(0.0);
    for (int c = 0; c < 3; ++c)
      if (radiance[c] > returned[c]) share[c] = (radiance[c] - returned[c]) / radiance[c];
    return glm::vec3(share);
  }

  glm::vec3 given(std::size_t j, std::uint32_t vertex) const {
    glm::vec3 sum(0.0f);
    for (const Given& source : given_[j]) sum += source.row[vertex] * source.share;
    return sum;
  }

  /// In steps of eight bits. Also at a vertex that nothing is taken from: what is taken is
  /// interpolated, and then rounded.
  float dither(std::size_t j) const {
    if (options_.precision != ShadowPrecision::dithered) return 0.0f;
    // The golden ratio's multiples are even over [0, 1) however many there are.
    const double turn = static_cast<double>(j + 1) * 0.6180339887498949;
    return static_cast<float>((turn - std::floor(turn) - 0.5) / 255.0);
  }

  const LitScene& scene_;
  const LightPaths& paths_;
  const Receivers& receivers_;
  const ShadowTakeOptions& options_;
  std::vector<SourceShadow>& shadows_;
  /// One list a shadow.
  std::vector<std::vector<Given>> given_;
  std::vector<std::uint8_t> first_set_;
};

/// What lies in the pyramid of a shadow's casters, behind the nearest of them.
class Pyramid {
 public:
  explicit Pyramid(const SourceShadow& shadow) : casters_(shadow.casters), near_m_(shadow.near_m) {}

  /// How far inside of each side a point of the light's view is; below 0: outside.
  std::array<double, 5> depths(const glm::dvec3& p) const {
    return {p.x - casters_.low.x * p.z, casters_.high.x * p.z - p.x, p.y - casters_.low.y * p.z,
            casters_.high.y * p.z - p.y, p.z - near_m_};
  }

  /// Corners of the part of a triangle that is inside; of its own corners' places in the world.
  void add_inside(const std::array<glm::dvec3, 3>& local, const std::array<glm::dvec3, 3>& world,
                  std::vector<glm::dvec3>& corners) const {
    struct Corner {
      glm::dvec3 world;
      std::array<double, 5> depths;
    };
    // A convex polygon gets one more corner a side, and rounding never twice as many.
    std::array<Corner, 96> polygon, next;
    std::size_t count = 3;
    for (std::size_t k = 0; k < 3; ++k) polygon[k] = {world[k], depths(local[k])};
    for (std::size_t side = 0; side < 5 && count > 0; ++side) {
      std::size_t kept = 0;
      for (std::size_t k = 0; k < count; ++k) {
        const Corner &a = polygon[k], &b = polygon[(k + 1) % count];
        const double da = a.depths[side], db = b.depths[side];
        if (da >= 0.0) next[kept++] = a;
        if ((da >= 0.0) == (db >= 0.0)) continue;
        Corner& cut = next[kept++];
        const double t = da / (da - db);
        cut.world = glm::mix(a.world, b.world, t);
        for (std::size_t s = 0; s < 5; ++s)
          cut.depths[s] = a.depths[s] + (b.depths[s] - a.depths[s]) * t;
      }
      std::swap(polygon, next);
      count = kept;
    }
    for (std::size_t k = 0; k < count; ++k) corners.push_back(polygon[k].world);
  }

 private:
  Rectangle casters_;
  double near_m_;
};

/// Keeps the triangles that the pyramid can touch, of those that something is taken from.
void keep_reached(const Receivers& receivers, std::span<const glm::vec4> positions,
                  SourceShadow& shadow) {
  const Pyramid pyramid(shadow);
  std::vector<glm::dvec3> local(positions.size());
  std::vector<std::uint8_t> outside(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    local[i] = shadow.view.local(glm::dvec3(positions[i]));
    const std::array<double, 5> depths = pyramid.depths(local[i]);
    unsigned bits = shadow.given[i] == 0 ? 1u << depths.size() : 0u;
    for (std::size_t side = 0; side < depths.size(); ++side)
      bits |= depths[side] < 0.0 ? 1u << side : 0u;
    outside[i] = static_cast<std::uint8_t>(bits);
  }
  shadow.indices.clear();
  shadow.reach.clear();
  for (std::size_t t = 0; t < receivers.indices.size(); t += 3) {
    const std::uint32_t* i = &receivers.indices[t];
    if ((outside[i[0]] & outside[i[1]] & outside[i[2]]) != 0) continue;
    const std::size_t before = shadow.reach.size();
    pyramid.add_inside(
        {local[i[0]], local[i[1]], local[i[2]]},
        {glm::dvec3(positions[i[0]]), glm::dvec3(positions[i[1]]), glm::dvec3(positions[i[2]])},
        shadow.reach);
    if (shadow.reach.size() > before) shadow.indices.insert(shadow.indices.end(), i, i + 3);
  }
}

}  // namespace

void find_shadows(const LitScene& scene, const LightPaths& paths, const OccludedLight& occluded,
                  std::span<const ShadowCaster> casters, const IrradianceVolume& light,
                  const ShadowTakeOptions& options, DifferentialShadows& result) {
  const std::vector<SourceCluster> clusters = choose_sources(paths, occluded, options.passes);
  result.occluded_sources = occluded.sources().size();
  result.receivers = occluded.receivers().size();
  result.left_out = 0;
  result.shadows.clear();
  for (const SourceCluster& cluster : clusters) {
    const std::uint32_t number = paths.transfers.sources[cluster.brightest];
    const Patch& patch = scene.model.patches[number];
    const std::optional<Cast> cast = cast_from(patch.center, casters);
    if (!cast) {
      ++result.left_out;
      continue;
    }
    result.shadows.push_back({.cluster = cluster,
                              .patch = number,
                              .light = glm::vec4(glm::vec3(patch.center), 1.0f),
                              .view = cast->view,
                              .casters = cast->casters,
                              .near_m = cast->near_m,
                              .far_m = cast->far_m});
  }
  const Receivers receivers = number_receivers(scene.model, occluded.receivers());
  result.positions.clear();
  for (const std::uint32_t v : receivers.vertices)
    result.positions.emplace_back(scene.model.vertices[v].position, 1.0f);
  Takes(scene, paths, receivers, occluded, casters, light, options, result.shadows).run();
  raster::for_each_chunk(result.shadows.size(), 1, options.threads,
                         [&](std::size_t first, std::size_t last) {
                           for (std::size_t j = first; j < last; ++j)
                             keep_reached(receivers, result.positions, result.shadows[j]);
                         });
}

}  // namespace gnomon::pipeline
