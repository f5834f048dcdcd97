#include "pipeline/basis.h"

#include <glm/geometric.hpp>

namespace gnomon::pipeline {

glm::dvec3 Basis::operator()(const glm::dvec3& p) const {
  return {glm::dot(u, p), glm::dot(v, p), glm::dot(axis, p)};
}

Basis basis_about(const glm::dvec3& axis) {
  // The coordinate axis that is farthest from being parallel.
  const glm::dvec3 size = glm::abs(axis);
  const glm::dvec3 across = size.x <= size.y && size.x <= size.z ? glm::dvec3(1.0, 0.0, 0.0)
                            : size.y <= size.z                   ? glm::dvec3(0.0, 1.0, 0.0)
                                                                 : glm::dvec3(0.0, 0.0, 1.0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, across));
  return {u, glm::normalize(glm::cross(axis, u)), axis};
}

}  // namespace gnomon::pipeline
