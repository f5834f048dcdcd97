#include "pipeline/ray_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "pipeline/embree_ray.h"
#include "pipeline/embree_triangles.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// How far a point is lifted off its surface before it looks for the light, as a part of its
/// coordinates' size: Embree's float32 triangles are off by about a tenth of this.
constexpr double kLift = 2e-6;

struct Triangles {
  /// World-space corners, exactly those that Embree has (float32).
  std::vector<glm::vec3> corners;
  std::vector<std::uint32_t> indices;
};

struct Body {
  Triangles seen;
  /// Where what casts is not what is seen.
  std::optional<Triangles> caster;
  bool casts = true;
  Role role = Role::virtual_object;
};

Triangles triangles_of(const Model& model, const glm::mat4& world_from_model) {
  Triangles triangles;
  const glm::dmat4 world(world_from_model);
  for (const Part& part : model.parts) {
    raster::require(part.mesh.indices.size() % 3 == 0, "a mesh has three indices a triangle");
    for (const std::uint32_t index : part.mesh.indices) {
      raster::require(index < part.mesh.positions.size(),
                      "a mesh's index names one of its positions");
      const glm::vec4& p = part.mesh.positions[index];
      triangles.indices.push_back(static_cast<std::uint32_t>(triangles.indices.size()));
      triangles.corners.emplace_back(glm::vec3(world * glm::dvec4(p)));
    }
  }
  return triangles;
}

Body make_body(const Object& object) {
  raster::require(object.model != nullptr, "an object has a model");
  Body body{.seen = triangles_of(*object.model, object.world_from_model),
            .caster = {},
            .casts = object.casts,
            .role = object.role};
  if (!object.casts_as_drawn())
    body.caster = triangles_of(*object.shadow_model, object.world_from_model);
  return body;
}

bool belongs(const Body& body, Among among) {
  return among == Among::all || (among == Among::phantoms) == (body.role == Role::phantom);
}

std::size_t slot(Among among) { return static_cast<std::size_t>(among); }

}  // namespace

struct RayReference::World {
  RTCDevice device = nullptr;
  std::vector<Body> bodies;
  /// By Among: everything, and what casts.
  std::array<RTCScene, 3> visible{}, casters{};

  explicit World(const Scene& scene) {
    for (const Object& object : scene.objects) bodies.push_back(make_body(object));
    device = rtcNewDevice(nullptr);
    if (!device) throw std::runtime_error("Embree cannot start");
    for (const Among among : {Among::all, Among::virtual_objects, Among::phantoms}) {
      visible[slot(among)] = build(among, false);
      casters[slot(among)] = build(among, true);
    }
  }
  ~World() {
    for (RTCScene scene : visible) rtcReleaseScene(scene);
    for (RTCScene scene : casters) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  RTCScene build(Among among, bool casters_only) const {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const Body& body = bodies[i];
      const Triangles& triangles = casters_only && body.caster ? *body.caster : body.seen;
      if (!belongs(body, among) || (casters_only && !body.casts) || triangles.indices.empty())
        continue;
      RTCGeometry geometry = make_triangles(device, triangles.corners, triangles.indices);
      rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(i));
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    return scene;
  }
};

RayReference::RayReference(const Scene& scene) : world_(std::make_unique<World>(scene)) {}
RayReference::~RayReference() = default;

RayHit RayReference::trace(const Ray& ray, Among visible) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = make_ray(ray.origin, ray.direction, std::numeric_limits<double>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(world_->visible[slot(visible)], &context, &query);
  RayHit result;
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return result;
  result.hit = true;
  result.object = query.hit.geomID;
  result.triangle = query.hit.primID;
  const Triangles& seen = world_->bodies[result.object].seen;
  const std::uint32_t* index = &seen.indices[3 * static_cast<std::size_t>(query.hit.primID)];
  const glm::dvec3 a(seen.corners[index[0]]), b(seen.corners[index[1]]), c(seen.corners[index[2]]);
  result.normal = glm::normalize(glm::cross(b - a, c - a));
  if (glm::dot(result.normal, ray.direction) > 0.0) result.normal = -result.normal;
  // Again in double: Embree's own distance has float32's rounding.
  const double along = glm::dot(result.normal, ray.direction);
  const double exact = glm::dot(result.normal, a - ray.origin) / along;
  result.distance = std::isfinite(exact) ? exact : static_cast<double>(query.ray.tfar);
  result.point = ray.origin + ray.direction * result.distance;
  return result;
}

bool RayReference::blocked(const glm::dvec3& point, const glm::vec4& light, Among casters) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  const bool directional = light.w == 0.0f;
  const glm::dvec3 towards = directional ? glm::dvec3(light) : glm::dvec3(light) - point;
  RTCRay ray =
      make_ray(point, towards, directional ? std::numeric_limits<double>::infinity() : 1.0);
  rtcOccluded1(world_->casters[slot(casters)], &context, &ray);
  return ray.tfar < 0.0f;
}

RayShadow RayReference::shadow(const RayHit& hit, const glm::vec4& light, Among casters) const {
  RayShadow result;
  if (!hit.hit) return result;
  const glm::dvec3 towards = light.w == 0.0f ? glm::dvec3(light) : glm::dvec3(light) - hit.point;
  result.faces_away = glm::dot(hit.normal, towards) <= 0.0;
  const Body& body = world_->bodies[hit.object];
  const bool own_shadow = result.faces_away && body.casts && !body.caster && belongs(body, casters);
  const double size =
      std::max({1.0, std::abs(hit.point.x), std::abs(hit.point.y), std::abs(hit.point.z)});
  const glm::dvec3 side = result.faces_away && !body.caster ? -hit.normal : hit.normal;
  result.blocked = blocked(hit.point + side * (kLift * size), light, casters);
  result.in_shadow = result.blocked || own_shadow;
  return result;
}

std::vector<RayReference::Sample> RayReference::cast(std::span<const Ray> rays,
                                                     const glm::vec4& light, Among visible,
                                                     Among casters) const {
  std::vector<Sample> samples;
  samples.reserve(rays.size());
  for (const Ray& ray : rays) {
    Sample sample{trace(ray, visible), {}};
    sample.shadow = shadow(sample.hit, light, casters);
    samples.push_back(sample);
  }
  return samples;
}

Ray window_ray(const Camera& camera, double x, double y) {
  const glm::dmat4 world_from_clip = glm::inverse(glm::dmat4(camera.clip_from_world));
  const double x_ndc = 2.0 * x / camera.width - 1.0, y_ndc = 2.0 * y / camera.height - 1.0;
  const glm::dvec4 near = world_from_clip * glm::dvec4(x_ndc, y_ndc, -1.0, 1.0);
  const glm::dvec3 eye(camera.eye_world);
  return {eye, glm::normalize(glm::dvec3(near) / near.w - eye)};
}

std::vector<Ray> pixel_rays(const Camera& camera) {
  std::vector<Ray> rays;
  rays.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) rays.push_back(window_ray(camera, x + 0.5, y + 0.5));
  }
  return rays;
}

}  // namespace gnomon::pipeline
