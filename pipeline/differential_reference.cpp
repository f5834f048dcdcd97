#include "pipeline/differential_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>

#include "pipeline/bounds.h"
#include "pipeline/object_light.h"
#include "pipeline/patch_light.h"
#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// Points of a patch that are asked for at an object's triangle: its light is one of a thousand.
constexpr int kGlowSamples = 1;

struct Sphere {
  glm::dvec3 center{0.0};
  double radius = 0.0;
};

Sphere sphere_of(const Bounds& box) {
  return {box.center(), 0.5 * glm::length(box.high - box.low)};
}

Bounds bounds_of_caster(const Object& object) {
  Bounds box;
  for (const Part& part : object.caster()->parts) {
    for (const glm::vec4& p : part.mesh.positions)
      box.add(glm::dvec3(glm::dmat4(object.world_from_model) * glm::dvec4(p)));
  }
  return box;
}

/// False only if no segment from the point to the patch's sphere meets the other sphere.
bool may_hide(const glm::dvec3& point, const Sphere& patch, const Sphere& object) {
  const glm::dvec3 axis = patch.center - point;
  const double square = glm::dot(axis, axis);
  if (!(square > 0.0)) return true;
  const double t = std::clamp(glm::dot(object.center - point, axis) / square, 0.0, 1.0);
  // At the part t of the way the cone is t times as wide as the patch.
  const double reach = object.radius + patch.radius;
  const glm::dvec3 apart = object.center - (point + axis * t);
  return glm::dot(apart, apart) <= reach * reach;
}

}  // namespace

struct DifferentialReference::World {
  const LitScene& scene;
  PatchVisibility patches;
  RayReference objects;
  /// Of vertices.
  std::vector<glm::vec3> reflectance, radiance;
  std::vector<Sphere> patch_spheres, casters;
  /// One an object: its first part's.
  std::vector<glm::dvec3> diffuse;
  Scene virtual_scene;

  World(const LitScene& lit, const Scene& virtual_objects)
      : scene(lit),
        patches(lit.model),
        objects(virtual_objects),
        reflectance(at_vertices(lit.model, lit.reflectance)),
        radiance(at_vertices(lit.model, lit.radiance)),
        virtual_scene(virtual_objects) {
    for (const Patch& patch : lit.model.patches) {
      Sphere sphere{patch.center, 0.0};
      for (std::size_t k = 0; k < 3; ++k)
        sphere.radius =
            std::max(sphere.radius, glm::length(lit.model.corner(patch, k) - patch.center));
      patch_spheres.push_back(sphere);
    }
    for (const Object& object : virtual_scene.objects) {
      if (object.casts) casters.push_back(sphere_of(bounds_of_caster(object)));
      diffuse.emplace_back(object.model->parts.empty()
                               ? glm::vec3(0.0f)
                               : linear_color(object.model->parts[0].material.diffuse));
    }
  }

  /// What virtual objects take from a receiver's point, as irradiance over pi. `glow` is what they
  /// give back, the radiance of each triangle of each object; empty: nothing.
  glm::dvec3 hidden(const glm::dvec3& point, const glm::dvec3& normal, int samples,
                    const std::vector<std::vector<glm::vec3>>& glow) const {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < patch_spheres.size(); ++i) {
      if (scene.radiance[i] == glm::vec3(0.0f)) continue;
      if (std::none_of(casters.begin(), casters.end(), [&](const Sphere& caster) {
            return may_hide(point, patch_spheres[i], caster);
          }))
        continue;
      const Patch& patch = scene.model.patches[i];
      const double factor = form_factor(point, normal, scene.model.corners(patch));
      if (factor <= 0.0) continue;
      glm::dvec3 returned(0.0);
      int hidden = 0;
      // The share of the patch's points that only virtual objects hide.
      const double share = patches.share_of_samples(
          patch, point, normal, samples, [&](const glm::dvec3& from, const glm::dvec3& to) {
            if (!objects.blocked(from, glm::vec4(glm::vec3(to), 1.0f)) ||
                !patches.sees(patch, from, to))
              return false;
            ++hidden;
            const RayHit hit = glow.empty() ? RayHit{} : objects.trace({from, to - from});
            if (hit.hit && hit.distance < 1.0 && virtual_scene.objects[hit.object].casts)
              returned += glm::dvec3(glow[hit.object][hit.triangle]);
            return true;
          });
      if (hidden > 0)
        sum += (glm::dvec3(scene.radiance[i]) - returned / static_cast<double>(hidden)) *
               (factor * share);
    }
    return sum;
  }

  /// The radiance of each triangle of each object at its middle.
  std::vector<std::vector<glm::vec3>> glow(int threads) const {
    std::vector<std::vector<glm::vec3>> all;
    for (std::size_t o = 0; o < virtual_scene.objects.size(); ++o) {
      const Object& object = virtual_scene.objects[o];
      std::vector<std::array<glm::dvec3, 3>> triangles;
      for (const Part& part : object.model->parts) {
        for (std::size_t t = 0; t + 2 < part.mesh.indices.size(); t += 3) {
          auto& corners = triangles.emplace_back();
          for (std::size_t k = 0; k < 3; ++k)
            corners[k] =
                glm::dvec3(object.world_from_model * part.mesh.positions[part.mesh.indices[t + k]]);
        }
      }
      std::vector<glm::vec3>& light = all.emplace_back(triangles.size(), glm::vec3(0.0f));
      raster::for_each_chunk(
          triangles.size(), 16, threads, [&](std::size_t first, std::size_t last) {
            for (std::size_t t = first; t < last; ++t) {
              const auto& [a, b, c] = triangles[t];
              const glm::dvec3 across = glm::cross(b - a, c - a);
              const double length = glm::length(across);
              if (!(length > 0.0)) continue;
              light[t] = glm::vec3(diffuse[o] *
                                   arriving((a + b + c) / 3.0, across / length, kGlowSamples));
            }
          });
    }
    return all;
  }

  /// Irradiance over pi on a virtual object, of all that nothing hides.
  glm::dvec3 arriving(const glm::dvec3& point, const glm::dvec3& normal, int samples) const {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < patch_spheres.size(); ++i) {
      if (scene.radiance[i] == glm::vec3(0.0f)) continue;
      const Patch& patch = scene.model.patches[i];
      const double factor = form_factor(point, normal, scene.model.corners(patch));
      if (factor <= 0.0) continue;
      const double share = patches.share_of_samples(
          patch, point, normal, samples, [&](const glm::dvec3& from, const glm::dvec3& to) {
            return !objects.blocked(from, glm::vec4(glm::vec3(to), 1.0f)) &&
                   patches.sees(patch, from, to);
          });
      sum += glm::dvec3(scene.radiance[i]) * (factor * share);
    }
    return sum;
  }
};

DifferentialReference::DifferentialReference(const LitScene& scene, const Scene& virtual_scene)
    : world_(std::make_unique<World>(scene, virtual_scene)) {}
DifferentialReference::~DifferentialReference() = default;

ReferencePicture DifferentialReference::render(std::span<const Ray> rays,
                                               std::span<const std::uint8_t> photograph,
                                               const ReferenceOptions& options) const {
  raster::require(photograph.size() == 3 * rays.size(), "a ray has three bytes of a photograph");
  ReferencePicture picture{{photograph.begin(), photograph.end()}, {}, {}};
  picture.object.resize(rays.size());
  picture.shadow.resize(rays.size());
  const World& world = *world_;
  std::vector<std::vector<glm::vec3>> glow;
  if (options.returned_light) glow = world.glow(options.threads);
  const ToneCurve& tone = world.scene.tone;
  const auto set = [&](std::size_t i, const glm::dvec3& radiance) {
    for (std::size_t c = 0; c < 3; ++c)
      picture.pixels[3 * i + c] =
          static_cast<std::uint8_t>(std::lround(tone.value(c, radiance[static_cast<int>(c)])));
  };
  const auto trace = [&](std::size_t i) {
    const Ray& ray = rays[i];
    const PatchVisibility::Hit patch_hit = world.patches.trace(ray.origin, ray.direction);
    const RayHit object_hit = world.objects.trace(ray);
    if (object_hit.hit &&
        !(patch_hit.patch != PatchVisibility::kNone && patch_hit.distance < object_hit.distance)) {
      picture.object[i] = 1;
      set(i, world.diffuse[object_hit.object] *
                 world.arriving(object_hit.point, object_hit.normal, options.object_samples));
      return;
    }
    if (patch_hit.patch == PatchVisibility::kNone || !patch_hit.front) return;
    const Patch& patch = world.scene.model.patches[patch_hit.patch];
    glm::dvec3 point(0.0), reflectance(0.0), whole(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      const double weight = patch_hit.weights[static_cast<int>(k)];
      point += world.scene.model.corner(patch, k) * weight;
      reflectance += glm::dvec3(world.reflectance[patch.vertices[k]]) * weight;
      whole += glm::dvec3(world.radiance[patch.vertices[k]]) * weight;
    }
    const glm::dvec3 taken = reflectance * world.hidden(point, patch.normal, options.samples, glow);
    if (taken == glm::dvec3(0.0)) return;
    picture.shadow[i] = 1;
    glm::dvec3 light(0.0);
    for (int c = 0; c < 3; ++c) {
      light[c] = tone.radiance(static_cast<std::size_t>(c),
                               photograph[3 * i + static_cast<std::size_t>(c)]);
      if (!options.by_share)
        light[c] -= taken[c];
      else if (whole[c] > 0.0)
        light[c] *= 1.0 - taken[c] / whole[c];
    }
    set(i, glm::max(light, glm::dvec3(0.0)));
  };
  raster::for_each_chunk(rays.size(), 64, options.threads,
                         [&](std::size_t first, std::size_t last) {
                           for (std::size_t i = first; i < last; ++i) trace(i);
                         });
  return picture;
}

}  // namespace gnomon::pipeline
