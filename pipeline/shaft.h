// The region of all lines between two boxes, as planes (Haines and Wallace 1991; Gibson 2003,
// section 6): the box around both, and planes that touch an edge of each.
// Invariant: conservative. A box that some line between the two meets is never said to miss.
#pragma once

#include <array>
#include <cstddef>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/bounds.h"

namespace gnomon::pipeline {

struct Shaft {
  Bounds box;
  /// Points inside have dot(xyz, p) <= w; at most four for each pair of axes.
  std::array<glm::dvec4, 12> planes;
  std::size_t plane_count = 0;

  /// False only if no line from one box to the other meets the object's.
  bool meets(const Bounds& object) const {
    if (!box.meets(object)) return false;
    for (std::size_t i = 0; i < plane_count; ++i) {
      const glm::dvec4& plane = planes[i];
      const double nearest = plane.x * (plane.x > 0.0 ? object.low.x : object.high.x) +
                             plane.y * (plane.y > 0.0 ? object.low.y : object.high.y) +
                             plane.z * (plane.z > 0.0 ? object.low.z : object.high.z);
      if (nearest > plane.w) return false;
    }
    return true;
  }
};

/// Precondition: neither box is empty.
Shaft make_shaft(const Bounds& a, const Bounds& b);

}  // namespace gnomon::pipeline
