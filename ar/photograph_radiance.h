// Radiance of the patches that a photograph sees: finer than any probe's picture of them.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "ar/camera.h"
#include "ar/image_file.h"
#include "pipeline/patch_light.h"

namespace gnomon::ar {

struct PhotographRadiance {
  /// The mean over each patch's pixels; 0 without.
  std::vector<glm::dvec3> radiance;
  /// How many pixels show each patch from the front, away from where surfaces hide others.
  std::vector<std::size_t> pixels;
  /// Share of the picture whose rays meet no front of a patch.
  double beside = 0.0;
};

/// `margin_px`: pixels this near to another surface of the model are left out, since models are
/// never quite where their originals are. Deterministic.
PhotographRadiance photograph_radiance(const FloatImage& picture, const Lens& lens,
                                       const glm::dmat4& world_from_camera,
                                       const pipeline::PatchVisibility& patches,
                                       const pipeline::PatchModel& model, int margin_px,
                                       int threads);

}  // namespace gnomon::ar
