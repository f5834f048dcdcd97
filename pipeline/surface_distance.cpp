#include "pipeline/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/point_tree.h"
#include "pipeline/topology.h"

namespace gnomon::pipeline {
namespace {

/// Steps of the lattice of samples along a triangle's edge.
constexpr int kSteps = 4;

double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                            const glm::dvec3& c) {
  const auto to_segment = [&p](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::distance(p, from + closest_on_segment(p, from, to) * (to - from));
  };
  double least = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double area2 = glm::dot(normal, normal);
  if (area2 > 0.0) {
    // Over the triangle, the foot on its plane is closer than any edge.
    const bool over = glm::dot(glm::cross(b - a, p - a), normal) >= 0.0 &&
                      glm::dot(glm::cross(c - b, p - b), normal) >= 0.0 &&
                      glm::dot(glm::cross(a - c, p - c), normal) >= 0.0;
    if (over) least = std::min(least, std::abs(glm::dot(p - a, normal)) / std::sqrt(area2));
  }
  return least;
}

/// A surface that answers how far a point is from it.
class Target {
 public:
  explicit Target(const Topology& topology)
      : topology_(topology), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(topology.triangle_count()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Target() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  double distance(const glm::dvec3& point) const {
    Query query{this, point, std::numeric_limits<double>::infinity()};
    RTCPointQuery box{.x = static_cast<float>(point.x),
                      .y = static_cast<float>(point.y),
                      .z = static_cast<float>(point.z),
                      .time = 0.0f,
                      .radius = std::numeric_limits<float>::infinity()};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_, &box, &context, look_at, &query);
    return query.least;
  }

 private:
  struct Query {
    const Target* target;
    glm::dvec3 point;
    double least;
  };

  glm::dvec3 corner(unsigned triangle, unsigned k) const {
    return glm::dvec3(topology_.positions[topology_.indices[3 * triangle + k]]);
  }

  static void bounds_of(const RTCBoundsFunctionArguments* arguments) {
    const auto& target = *static_cast<const Target*>(arguments->geometryUserPtr);
    const glm::vec3 a(target.corner(arguments->primID, 0)), b(target.corner(arguments->primID, 1)),
        c(target.corner(arguments->primID, 2));
    const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    *arguments->bounds_o = {.lower_x = low.x,
                            .lower_y = low.y,
                            .lower_z = low.z,  //
                            .upper_x = high.x,
                            .upper_y = high.y,
                            .upper_z = high.z};
  }

  static bool look_at(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const unsigned t = arguments->primID;
    const double distance =
        distance_to_triangle(query.point, query.target->corner(t, 0), query.target->corner(t, 1),
                             query.target->corner(t, 2));
    if (distance >= query.least) return false;
    query.least = distance;
    // A little wider than the rounding of the point to float, so that no nearer triangle is missed.
    arguments->query->radius = static_cast<float>(distance * 1.0001) + 1e-30f;
    return true;
  }

  const Topology& topology_;
  RTCDevice device_;
  RTCScene scene_;
};

double farthest_sample(const Topology& from, const Target& to) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < from.indices.size(); i += 3) {
    const glm::dvec3 a(from.positions[from.indices[i]]), b(from.positions[from.indices[i + 1]]),
        c(from.positions[from.indices[i + 2]]);
    for (int u = 0; u <= kSteps; ++u)
      for (int v = 0; u + v <= kSteps; ++v) {
        const glm::dvec3 p =
            a + (static_cast<double>(u) * (b - a) + static_cast<double>(v) * (c - a)) /
                    static_cast<double>(kSteps);
        farthest = std::max(farthest, to.distance(p));
      }
  }
  return farthest;
}

}  // namespace

double surface_distance(const Model& a, const Model& b) {
  const Topology from = build_topology(a), to = build_topology(b);
  if (from.triangle_count() == 0 || to.triangle_count() == 0) return 0.0;
  return std::max(farthest_sample(from, Target(to)), farthest_sample(to, Target(from)));
}

}  // namespace gnomon::pipeline
