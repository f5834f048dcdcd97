#include "pipeline/patch_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include "pipeline/embree_ray.h"
#include "pipeline/embree_triangles.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// How far the ends of a ray are lifted off their surfaces, as a part of their coordinates' size.
constexpr double kLift = 1e-5;

double size_of(const glm::dvec3& p) {
  return std::max({1.0, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// Lambert's sum term of an edge seen from the origin.
double edge_term(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& normal) {
  const glm::dvec3 across = glm::cross(a, b);
  const double length = glm::length(across);
  // The edge runs through the point, or is none: its angle times its share of the normal is 0.
  if (!(length > 0.0)) return 0.0;
  return std::atan2(length, glm::dot(a, b)) * glm::dot(across, normal) / length;
}

/// The centroids of a triangle cut in `samples` = 4^k, as weights of its corners.
std::vector<glm::dvec3> centroids(int samples) {
  const int rows = samples == 1 ? 1 : samples == 4 ? 2 : 4;
  std::vector<glm::dvec3> out;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < 2 * (rows - y) - 1; ++x) {
      // Upright triangles at even x, those that stand on a corner between them.
      const double third = x % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
      const double u = (x / 2 + third) / rows, v = (y + third) / rows;
      out.emplace_back(1.0 - u - v, u, v);
    }
  }
  return out;
}

}  // namespace

glm::dvec3 lifted(const glm::dvec3& point, const glm::dvec3& normal) {
  return point + normal * (kLift * size_of(point));
}

std::span<const glm::dvec3> patch_samples(int samples) {
  static const std::vector<glm::dvec3> one = centroids(1), four = centroids(4),
                                       sixteen = centroids(16);
  raster::require(samples == 1 || samples == 4 || samples == 16, "a patch has 1, 4 or 16 samples");
  return samples == 1 ? one : samples == 4 ? four : sixteen;
}

double form_factor(const glm::dvec3& point, const glm::dvec3& normal,
                   const std::array<glm::dvec3, 3>& triangle) {
  const glm::dvec3 a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
  // Not before the triangle: its normal points away.
  if (!(glm::dot(glm::cross(b - a, c - a), a) < 0.0)) return 0.0;
  // The part above the horizon, four corners at most.
  const std::array<glm::dvec3, 3> corners{a, b, c};
  std::array<glm::dvec3, 4> above;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &p = corners[k], &q = corners[(k + 1) % 3];
    const double dp = glm::dot(p, normal), dq = glm::dot(q, normal);
    if (dp >= 0.0) above[count++] = p;
    if ((dp >= 0.0) != (dq >= 0.0)) above[count++] = p + (q - p) * (dp / (dp - dq));
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < count; ++k)
    sum += edge_term(above[k], above[(k + 1) % count], normal);
  // Counter-clockwise for the one who looks at it: the sum is negative.
  return std::max(0.0, -sum / (2.0 * std::numbers::pi));
}

struct PatchVisibility::World {
  const PatchModel& model;
  RTCDevice device = nullptr;
  /// The patches of the scene itself, and those that distant patches do not shine through.
  RTCScene scene = nullptr, opaque = nullptr;

  explicit World(const PatchModel& patches) : model(patches) {
    device = rtcNewDevice(nullptr);
    if (!device) throw std::runtime_error("Embree cannot start");
    const std::size_t near = model.near_count();
    std::vector<bool> clear(model.surfaces.size(), false);
    for (const std::uint32_t surface : model.clear_surfaces) clear[surface] = true;
    std::vector<std::uint32_t> all, unclear;
    for (std::size_t i = 0; i < near; ++i) {
      const Patch& patch = model.patches[i];
      all.insert(all.end(), patch.vertices.begin(), patch.vertices.end());
      if (!clear[patch.surface])
        unclear.insert(unclear.end(), patch.vertices.begin(), patch.vertices.end());
    }
    std::vector<glm::vec3> corners;
    corners.reserve(model.vertices.size());
    for (const PatchVertex& vertex : model.vertices) corners.push_back(vertex.position);
    scene = build(corners, all);
    if (near < model.patches.size()) opaque = build(corners, unclear);
  }
  ~World() {
    rtcReleaseScene(scene);
    if (opaque) rtcReleaseScene(opaque);
    rtcReleaseDevice(device);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  RTCScene build(std::span<const glm::vec3> corners,
                 std::span<const std::uint32_t> triangles) const {
    RTCScene built = rtcNewScene(device);
    rtcSetSceneFlags(built, RTC_SCENE_FLAG_ROBUST);
    if (!triangles.empty()) {
      RTCGeometry geometry = make_triangles(device, corners, triangles);
      rtcAttachGeometry(built, geometry);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(built);
    return built;
  }

  bool is_free(RTCScene among, const glm::dvec3& from, const glm::dvec3& to) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = make_ray(from, to - from, 1.0);
    rtcOccluded1(among, &context, &ray);
    return !(ray.tfar < 0.0f);
  }
};

PatchVisibility::PatchVisibility(const PatchModel& model)
    : world_(std::make_unique<World>(model)) {}
PatchVisibility::~PatchVisibility() = default;

const PatchModel& PatchVisibility::model() const { return world_->model; }

bool PatchVisibility::sees(const glm::dvec3& from, const glm::dvec3& to) const {
  return world_->is_free(world_->scene, from, to);
}

bool PatchVisibility::sees(const Patch& patch, const glm::dvec3& from, const glm::dvec3& to) const {
  return world_->is_free(patch.distant ? world_->opaque : world_->scene, from, to);
}

double PatchVisibility::visible_share(const Patch& patch, const glm::dvec3& point,
                                      const glm::dvec3& normal, int samples) const {
  return share_of_samples(
      patch, point, normal, samples,
      [&](const glm::dvec3& from, const glm::dvec3& to) { return sees(patch, from, to); });
}

PatchVisibility::Hit PatchVisibility::trace(const glm::dvec3& origin,
                                            const glm::dvec3& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray = make_ray(origin, direction, std::numeric_limits<double>::infinity());
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(world_->scene, &context, &query);
  Hit hit;
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.patch = query.hit.primID;
  hit.distance = query.ray.tfar;
  const double u = query.hit.u, v = query.hit.v;
  hit.weights = {1.0 - u - v, u, v};
  hit.front = glm::dot(world_->model.patches[hit.patch].normal, direction) < 0.0;
  return hit;
}

glm::dvec3 irradiance(const PatchModel& model, const std::vector<glm::vec3>& radiance,
                      const PatchVisibility& visibility, const glm::dvec3& point,
                      const glm::dvec3& normal, int samples) {
  raster::require(radiance.size() == model.patches.size(), "a radiance belongs to each patch");
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    if (radiance[i] == glm::vec3(0.0f)) continue;
    const Patch& patch = model.patches[i];
    const double factor = form_factor(point, normal, model.corners(patch));
    if (factor <= 0.0) continue;
    sum += glm::dvec3(radiance[i]) *
           (std::numbers::pi * factor * visibility.visible_share(patch, point, normal, samples));
  }
  return sum;
}

}  // namespace gnomon::pipeline
