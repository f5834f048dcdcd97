#include "pipeline/silhouette.h"

#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vector_relational.hpp>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// One decision a triangle: the sign of dot(normal, light - corner * w), added up from x to z.
/// `reverse` is what a triangle is that turns its back: 0 or -1.
void mark_casting(const TrianglePlanes& planes, const glm::dvec4& light, int reverse,
                  std::span<std::int8_t> casting) {
  const double *nx = planes.normal_x.data(), *ny = planes.normal_y.data(),
               *nz = planes.normal_z.data();
  const float *ax = planes.corner_x.data(), *ay = planes.corner_y.data(),
              *az = planes.corner_z.data();
  const double w = light.w;
  for (std::size_t t = 0; t < casting.size(); ++t) {
    const double x = nx[t] * (light.x - static_cast<double>(ax[t]) * w);
    const double y = ny[t] * (light.y - static_cast<double>(ay[t]) * w);
    const double z = nz[t] * (light.z - static_cast<double>(az[t]) * w);
    const double facing = x + y + z;
    casting[t] = static_cast<std::int8_t>((facing > 0.0 ? 1 : 0) + (facing < 0.0 ? reverse : 0));
  }
}

/// Does the point, the origin here, lie on a triangle? A lamp that does is as good as inside: no
/// face is turned to it, and with all faces the volume is whole. Where it does so only by rounding,
/// a closed mesh that casts with all faces casts the same shadow.
bool on_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  constexpr double kRounding = 1e-9;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double twice_area = glm::length(normal);
  const double size = glm::length(a) + glm::length(b) + glm::length(c);
  if (!(twice_area > 0.0) || std::abs(glm::dot(normal, a)) > kRounding * twice_area * size)
    return false;
  const double least = -kRounding * twice_area * twice_area;
  return glm::dot(normal, glm::cross(a, b)) >= least &&
         glm::dot(normal, glm::cross(b, c)) >= least && glm::dot(normal, glm::cross(c, a)) >= least;
}

/// Is the point inside a closed mesh? Counts, with sign, where a line from it leaves. The line's
/// direction has no simple ratio, so that it meets no edge of a mesh made by hand.
bool encloses(const Topology& topology, const glm::dvec3& point) {
  const glm::dvec3 along(0.5773194, 0.6180339, 0.5336512);
  int leaves = 0;
  for (std::size_t t = 0; t < topology.triangle_count(); ++t) {
    const auto corner = [&](std::size_t k) {
      return glm::dvec3(topology.positions[topology.indices[3 * t + k]]) - point;
    };
    const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
    if (on_triangle(a, b, c)) return true;
    // The line passes the triangle if it turns the same way about its three edges.
    const double ab = glm::dot(along, glm::cross(a, b)), bc = glm::dot(along, glm::cross(b, c));
    const double ca = glm::dot(along, glm::cross(c, a));
    const bool front = ab >= 0.0 && bc >= 0.0 && ca >= 0.0;
    const bool back = ab < 0.0 && bc < 0.0 && ca < 0.0;
    if (!front && !back) continue;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double ahead = glm::dot(normal, a), rate = glm::dot(normal, along);
    if (rate != 0.0 && ahead / rate > 0.0) leaves += front ? 1 : -1;
  }
  return leaves != 0;
}

bool in_bounds(const Topology& topology, const glm::dvec3& point) {
  return glm::all(glm::lessThanEqual(topology.low, point)) &&
         glm::all(glm::lessThanEqual(point, topology.high));
}

/// Appends the outline among the edges [first, last), each of which is a pair.
void trace_pairs(const Topology& topology, std::uint32_t first, std::uint32_t last,
                 Silhouette& silhouette) {
  const std::int8_t* casting = silhouette.casting.data();
  for (std::uint32_t e = first; e < last; ++e) {
    const EdgePair pair = topology.pairs[e];
    const int sum = casting[pair.forward] - casting[pair.backward];
    if (sum == 0) continue;
    const Edge& edge = topology.edges[e];
    silhouette.edges.push_back(sum > 0 ? SilhouetteEdge{edge.a, edge.b, sum}
                                       : SilhouetteEdge{edge.b, edge.a, -sum});
  }
}

void trace_edge(const Topology& topology, const Edge& edge, Silhouette& silhouette) {
  int sum = 0;
  for (const EdgeUse& use : topology.uses_of(edge)) {
    sum += use.sign * silhouette.casting[use.triangle];
  }
  if (sum > 0) silhouette.edges.push_back({edge.a, edge.b, sum});
  if (sum < 0) silhouette.edges.push_back({edge.b, edge.a, -sum});
}

}  // namespace

glm::dvec4 light_in_model(const glm::vec4& light_world, const glm::mat4& world_from_model) {
  glm::dvec4 light(light_world);
  raster::require(std::isfinite(light.x) && std::isfinite(light.y) && std::isfinite(light.z) &&
                      (light.w == 0.0 || light.w == 1.0),
                  "a light is a finite point (w = 1) or direction (w = 0)");
  if (light.w == 0.0) {
    const double length = glm::length(glm::dvec3(light));
    raster::require(length > 0.0, "a light's direction is no null vector");
    light /= length;
  }
  const glm::dmat4 world(world_from_model);
  const double determinant = glm::determinant(glm::dmat3(world));
  raster::require(std::isfinite(determinant) && determinant != 0.0,
                  "an object's transform can be inverted");
  glm::dvec4 result = glm::inverse(world) * light;
  // The inverse of an affine matrix keeps w exactly in theory; rounding has no say in it.
  result.w = light.w;
  return result;
}

bool casts_both_sides(const Topology& topology, const glm::dvec4& light_model) {
  const glm::dvec3 light(light_model);
  return !topology.closed() ||
         (light_model.w != 0.0 && in_bounds(topology, light) && encloses(topology, light));
}

void find_casting(const Topology& topology, const glm::dvec4& light_model, bool both_sides,
                  std::vector<std::int8_t>& casting) {
  casting.resize(topology.triangle_count());
  mark_casting(topology.planes, light_model, both_sides ? -1 : 0, casting);
}

void find_silhouette(const Topology& topology, const glm::dvec4& light_model,
                     Silhouette& silhouette) {
  find_casting(topology, light_model, casts_both_sides(topology, light_model), silhouette.casting);
  silhouette.edges.clear();
  std::uint32_t next = 0;
  for (const std::uint32_t unpaired : topology.unpaired_edges) {
    trace_pairs(topology, next, unpaired, silhouette);
    trace_edge(topology, topology.edges[unpaired], silhouette);
    next = unpaired + 1;
  }
  trace_pairs(topology, next, static_cast<std::uint32_t>(topology.edges.size()), silhouette);
}

void find_classical_silhouette(const Topology& topology, const glm::dvec4& light_model,
                               Silhouette& silhouette) {
  find_casting(topology, light_model, false, silhouette.casting);
  silhouette.edges.clear();
  for (const Edge& edge : topology.edges) {
    const std::span<const EdgeUse> uses = topology.uses_of(edge);
    const auto faces = [&](std::size_t i) { return silhouette.casting[uses[i].triangle] != 0; };
    const bool first = faces(0), second = uses.size() > 1 && faces(1);
    if (first == second) continue;
    const bool forward = uses[first ? 0 : 1].sign > 0;
    silhouette.edges.push_back(forward ? SilhouetteEdge{edge.a, edge.b, 1}
                                       : SilhouetteEdge{edge.b, edge.a, 1});
  }
}

Silhouette find_silhouette(const Topology& topology, const glm::dvec4& light_model) {
  Silhouette silhouette;
  find_silhouette(topology, light_model, silhouette);
  return silhouette;
}

}  // namespace gnomon::pipeline
