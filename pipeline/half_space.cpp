#include "pipeline/half_space.h"

namespace gnomon::pipeline {

void clip(Polygon& polygon, std::span<const HalfSpace> region, Polygon& scratch) {
  for (const HalfSpace& half : region) {
    scratch.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3& p = polygon[i];
      const glm::dvec3& q = polygon[(i + 1) % polygon.size()];
      const double dp = half.of(p), dq = half.of(q);
      if (dp >= 0.0) scratch.push_back(p);
      if ((dp >= 0.0) != (dq >= 0.0)) scratch.push_back(p + (q - p) * (dp / (dp - dq)));
    }
    polygon.swap(scratch);
    if (polygon.empty()) return;
  }
}

}  // namespace gnomon::pipeline
