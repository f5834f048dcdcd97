// How strong the sun is in a captured scene: no camera's brackets reach its radiance, but what it
// lights is in the photograph, beside what it does not.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "ar/patch_balance.h"
#include "pipeline/patch_light.h"
#include "pipeline/patches.h"

namespace gnomon::ar {

/// Irradiance of a surface that faces the sun, in the unit of `input.radiance` times steradian. Of
/// surfaces with known patches in full sun and others in the shade, these give the reflectance
/// (pi * radiance / what arrives from the other patches), and with it those what the sun adds;
/// the median over all patches in the sun, a channel at a time. Absent where no surface has both in
/// every channel. `input` has no radiance for the sun's patch. Preconditions: as balance_patches; a
/// sun.
std::optional<glm::dvec3> find_sun_irradiance(const pipeline::PatchModel& model,
                                              const pipeline::PatchExchange& exchange,
                                              const pipeline::PatchVisibility& visibility,
                                              const BalanceInput& input, int threads);

}  // namespace gnomon::ar
