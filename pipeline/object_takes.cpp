#include "pipeline/object_takes.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>

#include "pipeline/bounds.h"
#include "pipeline/displaced_caster.h"
#include "pipeline/intensity_transfer.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// A triangle that is turned from the eye by less than this counts as seen: coordinates are rounded
/// before the rasterizer decides.
constexpr double kLeastCosine = -1e-3;
/// Of a caster's size: corners that are no farther before a triangle's plane lie in it, but for the
/// rounding of their coordinates.
constexpr double kFlat = 1e-5;

/// A shadow's light as it falls on one object.
struct PointSource {
  glm::dvec3 position, normal;
  /// Of its light, what the room lets through to the object's middle.
  glm::dvec3 intensity;
  std::uint8_t first_set;
};

/// A caster's corners in the world, and how far before a plane they count.
struct CasterPoints {
  std::vector<glm::dvec3> points;
  double least_m = 0.0;
};

CasterPoints points_of(const PlacedObject& object) {
  const glm::dmat4 world(object.object->world_from_model);
  CasterPoints caster;
  for (const glm::vec4& p : object.caster_topology->positions)
    caster.points.emplace_back(world * glm::dvec4(p));
  const double scale =
      std::max({glm::length(world[0]), glm::length(world[1]), glm::length(world[2])});
  const double size = scale * static_cast<double>(glm::length(glm::vec3(
                                  object.caster_topology->high - object.caster_topology->low)));
  caster.least_m = kFlat * size;
  if (is_displaced(*object.object))
    caster.least_m += scale * static_cast<double>(object.object->shadow_displace);
  return caster;
}

bool any_before(const glm::dvec3& corner, const glm::dvec3& normal,
                std::span<const CasterPoints> casters) {
  return std::ranges::any_of(casters, [&](const CasterPoints& caster) {
    const double from = glm::dot(normal, corner) + caster.least_m;
    return std::ranges::any_of(caster.points,
                               [&](const glm::dvec3& p) { return glm::dot(normal, p) > from; });
  });
}

/// The mesh's triangles that may be in a shadow, and that may be seen from the eye: those that face
/// it, of a closed mesh whose front is outside and that the eye is outside of.
std::vector<std::uint32_t> shadowed_triangles(const PlacedObject& object, const Mesh& mesh,
                                              const glm::dvec3& eye,
                                              std::span<const CasterPoints> casters, int threads) {
  if (!object.topology->faults.closed_manifold()) return mesh.indices;
  const glm::dmat4 world(object.object->world_from_model);
  std::vector<glm::dvec3> positions;
  positions.reserve(mesh.positions.size());
  Bounds box;
  for (const glm::vec4& p : mesh.positions) {
    positions.emplace_back(world * glm::dvec4(p));
    box.add(positions.back());
  }
  const double side = object.front_face == raster::FrontFace::ccw ? 1.0 : -1.0;
  const std::size_t count = mesh.indices.size() / 3;
  double volume = 0.0;
  for (std::size_t t = 0; t < count; ++t) {
    const std::uint32_t* i = &mesh.indices[3 * t];
    const glm::dvec3 origin = box.center();
    volume += side * glm::dot(positions[i[0]] - origin,
                              glm::cross(positions[i[1]] - origin, positions[i[2]] - origin));
  }
  Bounds at_eye;
  at_eye.add(eye);
  const bool front_is_seen = volume > 0.0 && !box.meets(at_eye);
  std::vector<std::uint8_t> wanted(count);
  constexpr std::size_t kChunk = 128;
  raster::for_each_chunk(count, kChunk, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t t = first; t < last; ++t) {
      const std::uint32_t* i = &mesh.indices[3 * t];
      const glm::dvec3 &a = positions[i[0]], &b = positions[i[1]], &c = positions[i[2]];
      const glm::dvec3 normal = glm::cross(b - a, c - a) * side, to = eye - a;
      const double length = glm::length(normal);
      const bool faces = glm::dot(normal, to) > kLeastCosine * length * glm::length(to);
      wanted[t] = front_is_seen ? faces && any_before(a, normal / length, casters)
                                : any_before(a, normal / length, casters) ||
                                      any_before(a, -normal / length, casters);
    }
  });
  std::vector<std::uint32_t> kept;
  for (std::size_t t = 0; t < count; ++t)
    if (wanted[t]) kept.insert(kept.end(), &mesh.indices[3 * t], &mesh.indices[3 * t] + 3);
  return kept;
}

class MeshTaker {
 public:
  MeshTaker(const LitScene& scene, const ShadowTakeOptions& options,
            std::span<const PointSource> sources)
      : scene_(scene), options_(options), sources_(sources) {
    for (const PointSource& source : sources) first_set_.push_back(source.first_set);
  }

  /// `radiance` is one a vertex; colours are found for vertices of the triangles `seen`.
  void take(const PlacedObject& object, std::size_t part, std::span<const glm::vec3> radiance,
            std::span<const std::uint32_t> seen, std::span<MeshTake*> takes) const {
    const Mesh& mesh = *object.meshes[part];
    const glm::dvec3 diffuse(linear_color(object.object->model->parts[part].material.diffuse));
    for (MeshTake* take : takes) take->colors.resize(mesh.positions.size());
    std::vector<std::uint8_t> wanted(mesh.positions.size(), 0);
    for (const std::uint32_t v : seen) wanted[v] = 1;
    constexpr std::size_t kChunk = 64;
    raster::for_each_chunk(
        mesh.positions.size(), kChunk, options_.threads, [&](std::size_t first, std::size_t last) {
          std::vector<glm::vec3> transfers(sources_.size()), values(sources_.size());
          for (std::size_t v = first; v < last; ++v) {
            if (!wanted[v]) continue;
            const glm::dvec3 at(object.object->world_from_model * mesh.positions[v]);
            const glm::dvec3 normal =
                glm::normalize(glm::dvec3(object.world_from_model_normal * mesh.normals[v]));
            for (std::size_t j = 0; j < sources_.size(); ++j)
              transfers[j] = glm::vec3(diffuse * arriving(sources_[j], at, normal));
            if (options_.precision == ShadowPrecision::radiance) {
              values = transfers;
            } else {
              intensity_transfers(scene_.tone, glm::dvec3(radiance[v]), transfers, first_set_,
                                  values);
              for (glm::vec3& value : values) value /= 255.0f;
            }
            for (std::size_t j = 0; j < sources_.size(); ++j)
              takes[j]->colors[v] = glm::vec4(values[j], 0.0f);
          }
        });
    for (MeshTake* take : takes)
      take->any = std::ranges::any_of(
          seen, [&](std::uint32_t v) { return take->colors[v] != glm::vec4(0.0f); });
  }

 private:
  /// Irradiance over pi.
  static glm::dvec3 arriving(const PointSource& source, const glm::dvec3& at,
                             const glm::dvec3& normal) {
    const glm::dvec3 to = source.position - at;
    const double here = glm::dot(to, normal), there = -glm::dot(to, source.normal);
    if (!(here > 0.0 && there > 0.0)) return glm::dvec3(0.0);
    const double square = glm::dot(to, to);
    return source.intensity * (here * there / (square * square * std::numbers::pi));
  }

  const LitScene& scene_;
  const ShadowTakeOptions& options_;
  std::span<const PointSource> sources_;
  std::vector<std::uint8_t> first_set_;
};

std::vector<PointSource> sources_at(const LitScene& scene, const PatchVisibility& visibility,
                                    const PlacedObject& object,
                                    std::span<const SourceShadow> shadows,
                                    const ShadowTakeOptions& options) {
  constexpr int kRays = 4;
  const Topology& topology = *object.topology;
  const glm::dvec3 middle(object.object->world_from_model *
                          glm::vec4(glm::vec3((topology.low + topology.high) * 0.5), 1.0f));
  std::vector<PointSource> sources;
  for (const SourceShadow& shadow : shadows) {
    const Patch& patch = scene.model.patches[shadow.patch];
    const double seen =
        visibility.visible_share(patch, middle, glm::normalize(patch.center - middle), kRays);
    sources.push_back({patch.center, patch.normal, glm::dvec3(shadow.intensity) * seen,
                       in_first_set(shadow.cluster.brightest, options.first_share)
                           ? std::uint8_t{1}
                           : std::uint8_t{0}});
  }
  return sources;
}

}  // namespace

void take_from_objects(const LitScene& scene, const PatchVisibility& visibility,
                       std::span<const PlacedObject> objects, const ObjectRadiance& radiance,
                       std::span<const SourceShadow> shadows, const glm::vec3& eye_world,
                       const ShadowTakeOptions& options, ObjectTakes& result) {
  std::size_t meshes = 0;
  for (const PlacedObject& object : objects) meshes += object.meshes.size();
  result.indices.assign(meshes, {});
  result.of_shadow.resize(shadows.size());
  for (std::vector<MeshTake>& takes : result.of_shadow) takes.resize(meshes);
  std::vector<CasterPoints> casters;
  for (const PlacedObject& object : objects)
    if (object.object->casts) casters.push_back(points_of(object));
  std::size_t number = 0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const PlacedObject& object = objects[i];
    const auto sources = sources_at(scene, visibility, object, shadows, options);
    const MeshTaker taker(scene, options, sources);
    std::size_t first_vertex = 0;
    for (std::size_t p = 0; p < object.meshes.size(); ++p, ++number) {
      const Mesh& mesh = *object.meshes[p];
      std::vector<MeshTake*> takes;
      for (std::vector<MeshTake>& of_shadow : result.of_shadow) takes.push_back(&of_shadow[number]);
      for (MeshTake* take : takes) take->any = false;
      const auto light = std::span(radiance[i]).subspan(first_vertex, mesh.positions.size());
      first_vertex += mesh.positions.size();
      if (!object.object->receives) continue;
      std::vector<std::uint32_t>& indices = result.indices[number];
      indices = shadowed_triangles(object, mesh, glm::dvec3(eye_world), casters, options.threads);
      if (indices.empty()) continue;
      taker.take(object, p, light, indices, takes);
    }
  }
}

}  // namespace gnomon::pipeline
