// A ray as Embree takes it. Internal to pipeline/: shows Embree.
#pragma once

#include <embree3/rtcore.h>
#include <glm/vec3.hpp>

namespace gnomon::pipeline {

/// From the origin to `far` lengths of the direction, rounded to float32.
inline RTCRay make_ray(const glm::dvec3& origin, const glm::dvec3& direction, double far) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(origin.x);
  ray.org_y = static_cast<float>(origin.y);
  ray.org_z = static_cast<float>(origin.z);
  ray.dir_x = static_cast<float>(direction.x);
  ray.dir_y = static_cast<float>(direction.y);
  ray.dir_z = static_cast<float>(direction.z);
  ray.tfar = static_cast<float>(far);
  ray.mask = 0xffffffffu;
  return ray;
}

}  // namespace gnomon::pipeline
