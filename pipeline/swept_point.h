// Where a vertex of a shadow volume goes when it is swept away from the light: one expression, in
// one order of operations, for all who sweep. Lights are in model space (light_in_model).
#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "raster/check.h"

namespace gnomon::pipeline {

/// v goes to the direction (v - L, 0), or to (-d, 0) for a direction.
inline auto swept_to_infinity(const glm::dvec4& light_model) {
  return
      [light = glm::dvec3(light_model), directional = light_model.w == 0.0](const glm::dvec3& v) {
        return glm::vec4(glm::dvec4(directional ? -light : v - light, 0.0));
      };
}

/// v goes to L + amount * (v - L), or by `amount` away from a direction.
/// Errors: an amount that is negative or not finite.
inline auto swept_by(const glm::dvec4& light_model, double amount) {
  raster::require(std::isfinite(amount) && amount >= 0.0, "a sweep is finite and not negative");
  return [light = glm::dvec3(light_model), directional = light_model.w == 0.0,
          amount](const glm::dvec3& v) {
    return glm::vec4(
        glm::dvec4(directional ? v - light * amount : light + (v - light) * amount, 1.0));
  };
}

/// v goes radius_m metres of the world along its ray from a point; one where the light is stays.
/// Precondition: a point. Errors: a radius that is not positive or not finite.
inline auto swept_by_radius(const glm::dvec4& light_model, const glm::mat4& world_from_model,
                            double radius_m) {
  raster::require(std::isfinite(radius_m) && radius_m > 0.0, "a radius is positive and finite");
  return [light = glm::dvec3(light_model), world = glm::dmat3(glm::dmat4{world_from_model}),
          radius_m](const glm::dvec3& v) {
    const double ray_m = glm::length(world * (v - light));
    const double stretch = ray_m > 0.0 ? radius_m / ray_m : 0.0;
    return glm::vec4(glm::dvec4(v + (v - light) * stretch, 1.0));
  };
}

}  // namespace gnomon::pipeline
