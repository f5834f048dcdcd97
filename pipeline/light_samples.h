// A light with a radius as several lights without: its soft shadow is the sum of their hard ones.
// Invariant: shares and colours add up to the light's own; the points depend on the arguments only.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/scene.h"

namespace gnomon::pipeline {

inline constexpr int kMaxLightSamples = 1024;

/// `light.samples` lights without radius, each with 1/samples of share and colour. They lie on the
/// disc that a spherical light shows to `facing` (world space): point i at the radius
/// r sqrt((i + 1/2) / n), each turned by the golden angle against the one before (Vogel 1979), so
/// that every point stands for the same area. A light at infinity is sampled over the directions of
/// its disc (tangent of the angle taken as the angle). One sample, or no radius, is the centre.
/// Precondition: 1 to kMaxLightSamples samples; a finite radius of at least 0; a share in [0, 1].
std::vector<Light> sample_light(const Light& light, const glm::vec3& facing);

/// All lights of a scene so sampled; discs face the middle of the scene's bounding box. Samples of
/// one light follow each other and are named "name 1/8".
std::vector<Light> sample_lights(const Scene& scene);

}  // namespace gnomon::pipeline
