// How much light each patch gets from each other: form factors with visibility, found once for all
// pairs, so that the light between patches can be summed many times (radiosity's matrix; Gibson
// 2003, section 5, has the same factors to receivers' vertices).
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/patch_light.h"

namespace gnomon::pipeline {

class PatchExchange {
 public:
  /// The pairs are as many as the square of the patches.
  static constexpr std::size_t kMostPatches = 8192;

  /// `samples` as for PatchVisibility::visible_share. Takes the patches' centres as receivers.
  /// Misuse: more than kMostPatches patches.
  PatchExchange(const PatchModel& model, const PatchVisibility& visibility, int samples,
                int threads);

  /// At each patch's centre, what pipeline::irradiance gives there to float precision of the
  /// factors. `radiance` is one a patch. Deterministic: summed in order.
  std::vector<glm::dvec3> irradiance(const std::vector<glm::vec3>& radiance, int threads) const;

 private:
  std::size_t patches_ = 0;
  /// Of receiver i from source j, pi left out: factors_[i * patches_ + j].
  std::vector<float> factors_;
};

}  // namespace gnomon::pipeline
