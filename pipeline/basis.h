// A right-angled basis about an axis, in double.
#pragma once

#include <glm/vec3.hpp>

namespace gnomon::pipeline {

struct Basis {
  glm::dvec3 u, v, axis;
  /// The coordinates of p.
  glm::dvec3 operator()(const glm::dvec3& p) const;
};

/// u, v and the axis are of unit length. Precondition: so is `axis`.
Basis basis_about(const glm::dvec3& axis);

}  // namespace gnomon::pipeline
