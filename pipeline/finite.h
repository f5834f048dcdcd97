// Is a point one?
#pragma once

#include <cmath>

#include <glm/vec3.hpp>

namespace gnomon::pipeline {

/// No coordinate is infinite or NaN.
template <class T>
bool is_finite(const glm::vec<3, T>& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace gnomon::pipeline
