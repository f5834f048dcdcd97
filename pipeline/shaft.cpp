#include "pipeline/shaft.h"

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>

namespace gnomon::pipeline {
namespace {

/// Of a coordinate's size: what rounding can move a plane by, many times over.
constexpr double kSlack = 1e-12;

/// Adds the planes along the third axis that join a corner of each rectangle (u, v of the boxes)
/// and have both on one side: two, where the rectangles are not one in the other.
void add_planes(const Bounds& a, const Bounds& b, int u, int v, Shaft& shaft) {
  for (const bool u_high : {false, true}) {
    for (const bool v_high : {false, true}) {
      // The corner of each that is farthest where both coordinates grow (or fall).
      const glm::dvec2 p((u_high ? a.high : a.low)[u], (v_high ? a.high : a.low)[v]);
      const glm::dvec2 q((u_high ? b.high : b.low)[u], (v_high ? b.high : b.low)[v]);
      glm::dvec2 normal(p.y - q.y, q.x - p.x);
      // Outwards: towards this corner's quadrant. A line of the other kind of slope bounds nothing.
      const glm::dvec2 out(u_high ? 1.0 : -1.0, v_high ? 1.0 : -1.0);
      if (normal.x * out.x < 0.0 || normal.y * out.y < 0.0) normal = -normal;
      if (!(normal.x * out.x > 0.0 && normal.y * out.y > 0.0)) continue;
      glm::dvec4 plane(0.0);
      plane[u] = normal.x;
      plane[v] = normal.y;
      const double at_p = normal.x * p.x + normal.y * p.y, at_q = normal.x * q.x + normal.y * q.y;
      const double size = std::abs(normal.x * p.x) + std::abs(normal.y * p.y) +
                          std::abs(normal.x * q.x) + std::abs(normal.y * q.y);
      plane.w = std::max(at_p, at_q) + kSlack * size;
      if (shaft.plane_count < shaft.planes.size()) shaft.planes[shaft.plane_count++] = plane;
    }
  }
}

}  // namespace

Shaft make_shaft(const Bounds& a, const Bounds& b) {
  Shaft shaft;
  shaft.box = a;
  shaft.box.add(b);
  add_planes(a, b, 0, 1, shaft);
  add_planes(a, b, 0, 2, shaft);
  add_planes(a, b, 1, 2, shaft);
  return shaft;
}

}  // namespace gnomon::pipeline
