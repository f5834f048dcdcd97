// An axis-aligned box.
#pragma once

#include <limits>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace gnomon::pipeline {

/// Of what was added; without anything, low is above high.
struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  void add(const Bounds& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  glm::dvec3 center() const { return (low + high) * 0.5; }
  bool meets(const Bounds& other) const {
    return low.x <= other.high.x && low.y <= other.high.y && low.z <= other.high.z &&
           other.low.x <= high.x && other.low.y <= high.y && other.low.z <= high.z;
  }
};

}  // namespace gnomon::pipeline
