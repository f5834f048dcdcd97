#include "pipeline/self_intersection.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <utility>

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace gnomon::pipeline {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

/// Six times the signed volume of the tetrahedron.
double side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  return glm::dot(d - a, glm::cross(b - a, c - a));
}

bool edge_meets(const glm::dvec3& p, const glm::dvec3& q, const Triangle& t) {
  const double at_p = side(t[0], t[1], t[2], p), at_q = side(t[0], t[1], t[2], q);
  if ((at_p > 0.0) == (at_q > 0.0) && at_p != 0.0 && at_q != 0.0) return false;
  if (at_p == 0.0 && at_q == 0.0) return false;
  const double s0 = side(p, q, t[0], t[1]), s1 = side(p, q, t[1], t[2]),
               s2 = side(p, q, t[2], t[0]);
  return (s0 >= 0.0 && s1 >= 0.0 && s2 >= 0.0) || (s0 <= 0.0 && s1 <= 0.0 && s2 <= 0.0);
}

bool meet(const Triangle& s, const Triangle& t) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (edge_meets(s[k], s[(k + 1) % 3], t) || edge_meets(t[k], t[(k + 1) % 3], s)) return true;
  }
  return false;
}

/// What Embree's callbacks see.
struct Search {
  const Topology& topology;
  std::mutex mutex;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;

  const std::uint32_t* corners(std::uint32_t t) const { return &topology.indices[3 * t]; }
  Triangle triangle(std::uint32_t t) const {
    const std::uint32_t* c = corners(t);
    return {glm::dvec3(topology.positions[c[0]]), glm::dvec3(topology.positions[c[1]]),
            glm::dvec3(topology.positions[c[2]])};
  }
  bool share_a_vertex(std::uint32_t s, std::uint32_t t) const {
    return std::find_first_of(corners(s), corners(s) + 3, corners(t), corners(t) + 3) !=
           corners(s) + 3;
  }
};

void bounds_of(const RTCBoundsFunctionArguments* arguments) {
  const auto& search = *static_cast<const Search*>(arguments->geometryUserPtr);
  const std::uint32_t* c = search.corners(arguments->primID);
  const auto& positions = search.topology.positions;
  const glm::vec3 a(positions[c[0]]), b(positions[c[1]]), d(positions[c[2]]);
  const glm::vec3 low = glm::min(a, glm::min(b, d)), high = glm::max(a, glm::max(b, d));
  RTCBounds& bounds = *arguments->bounds_o;
  bounds = {.lower_x = low.x,
            .lower_y = low.y,
            .lower_z = low.z,  //
            .upper_x = high.x,
            .upper_y = high.y,
            .upper_z = high.z};
}

void look_at_pairs(void* user, RTCCollision* pairs, unsigned int count) {
  auto& search = *static_cast<Search*>(user);
  for (unsigned int i = 0; i < count; ++i) {
    const auto [s, t] = std::minmax(pairs[i].primID0, pairs[i].primID1);
    if (s == t || search.share_a_vertex(s, t)) continue;
    if (!meet(search.triangle(s), search.triangle(t))) continue;
    const std::lock_guard lock(search.mutex);
    if (search.found.size() == search.found.capacity()) return;
    search.found.emplace_back(s, t);
  }
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(const Topology& topology) {
  Search search{.topology = topology};
  // All there will be: Embree's callback cannot throw.
  search.found.reserve(kMostIntersections);
  const RTCDevice device = rtcNewDevice(nullptr);
  const RTCScene scene = rtcNewScene(device);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(topology.triangle_count()));
  rtcSetGeometryUserData(geometry, &search);
  rtcSetGeometryBoundsFunction(geometry, bounds_of, nullptr);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (topology.triangle_count() > 1) rtcCollide(scene, scene, look_at_pairs, &search);
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  // Embree may report a pair in both orders, and in any sequence.
  std::sort(search.found.begin(), search.found.end());
  search.found.erase(std::unique(search.found.begin(), search.found.end()), search.found.end());
  return std::move(search.found);
}

}  // namespace gnomon::pipeline
