// What patches reflect and what unseen ones give, from the light that goes between them all.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/patch_exchange.h"
#include "pipeline/patches.h"

namespace gnomon::ar {

struct BalanceInput {
  /// Outgoing radiance, one a patch; without meaning where it is not known.
  std::vector<glm::dvec3> radiance;
  std::vector<bool> known;
  /// The model's own guess of each surface's diffuse reflectance, in [0, 1].
  std::vector<glm::vec3> surface_reflectance;
};

struct Balanced {
  std::vector<glm::vec3> radiance, reflectance;
  /// Patches that give more than they get.
  std::vector<bool> emits;
};

/// Reflectance is pi * radiance / irradiance, within [0.02, 0.95]; a patch that gives more than it
/// gets shines by itself and keeps its surface's guess. An unknown patch gets the mean reflectance
/// of its surface's known ones (the guess where there are none) and gives back that part of what
/// it receives, found with all unknown patches at once; on a surface whose known patches shine, it
/// shines as they do on average. Deterministic.
Balanced balance_patches(const pipeline::PatchModel& model, const pipeline::PatchExchange& exchange,
                         const BalanceInput& input, int threads);

}  // namespace gnomon::ar
