// Convex polygons cut to half spaces, in double.
#pragma once

#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace gnomon::pipeline {

/// The points p with dot(normal, p) >= offset.
struct HalfSpace {
  glm::dvec3 normal{0.0};
  double offset = 0.0;
  double of(const glm::dvec3& p) const { return glm::dot(normal, p) - offset; }
};

using Polygon = std::vector<glm::dvec3>;

/// Leaves of the polygon what lies in all half spaces; empty if nothing does. `scratch` is memory.
void clip(Polygon& polygon, std::span<const HalfSpace> region, Polygon& scratch);

}  // namespace gnomon::pipeline
