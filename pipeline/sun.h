// Directional sunlight in a scene of patches (beyond Gibson 2003, whose light is all in the room):
// one more patch of the sun's solid angle, so far away that its rays are parallel. To everything
// that works with patches it is a source like others.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/patches.h"

namespace gnomon::pipeline {

/// Half the angle that the sun is seen under, in radians.
inline constexpr double kSunRadiusRad = 0.00465;

/// Appends the sun's patch, on a surface of its own, "sun". `direction` points towards it and has
/// unit length. It shines through the surfaces `clear` (panes that are in the model because they
/// give light of their own), and what lies before others is lit as they are open.
/// Misuse: no patch yet, or a sun already; a surface that does not exist.
void add_sun(PatchModel& model, const glm::dvec3& direction, std::vector<std::uint32_t> clear);

/// The sun's patch. Precondition: there is one.
std::uint32_t sun_patch(const PatchModel& model);

/// The radiance that gives a surface that faces the sun this irradiance.
glm::dvec3 sun_radiance(const glm::dvec3& irradiance);

}  // namespace gnomon::pipeline
