#include "pipeline/silhouette.h"

#include <cmath>
#include <cstdlib>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

std::int8_t casting_side(const Topology& topology, std::size_t triangle, const glm::dvec4& light,
                         bool both_sides) {
  const glm::dvec3 a(topology.positions[topology.indices[3 * triangle]]);
  const glm::dvec3 b(topology.positions[topology.indices[3 * triangle + 1]]);
  const glm::dvec3 c(topology.positions[topology.indices[3 * triangle + 2]]);
  const double facing = glm::dot(glm::cross(b - a, c - a), glm::dvec3(light) - a * light.w);
  if (facing > 0.0) return 1;
  if (facing < 0.0 && both_sides) return -1;
  return 0;
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

Silhouette find_silhouette(const Topology& topology, const glm::dvec4& light_model) {
  Silhouette silhouette;
  const bool both_sides =
      !topology.closed() || (light_model.w != 0.0 && encloses(topology, glm::dvec3(light_model)));
  silhouette.casting.resize(topology.triangle_count());
  for (std::size_t t = 0; t < topology.triangle_count(); ++t) {
    silhouette.casting[t] = casting_side(topology, t, light_model, both_sides);
  }
  for (const Edge& edge : topology.edges) {
    int sum = 0;
    for (const EdgeUse& use : topology.uses_of(edge)) {
      sum += use.sign * silhouette.casting[use.triangle];
    }
    if (sum > 0) silhouette.edges.push_back({edge.a, edge.b, sum});
    if (sum < 0) silhouette.edges.push_back({edge.b, edge.a, -sum});
  }
  return silhouette;
}

}  // namespace gnomon::pipeline
