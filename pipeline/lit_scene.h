// A real scene with the light that was measured in it (Gibson 2003, section 3): what is computed
// once and then serves every frame.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/patches.h"
#include "pipeline/tone_curve.h"

namespace gnomon::pipeline {

/// Radiance from all around a point, as a picture of directions: rows from the top (+y), longitude
/// 0 is +z at column 0's left edge, growing towards +x (OpenEXR's latitude-longitude map).
struct DirectionMap {
  int width = 0, height = 0;
  std::vector<glm::vec3> radiance;
  /// Where it was taken, in metres.
  glm::vec3 center{0.0f};

  /// The texel that holds a direction (of any length but 0).
  const glm::vec3& at(const glm::dvec3& direction) const;
  /// The unit direction of a place in the map, (0, 0) the top left corner, (1, 1) the bottom right.
  static glm::dvec3 direction(double u, double v);
  /// Inverse of `direction`.
  static void place(const glm::dvec3& direction, double& u, double& v);
};

/// Light is in the unit of the photograph's radiance, in which `tone` gives its pixels.
struct LitScene {
  PatchModel model;
  /// One a patch: outgoing radiance, and diffuse reflectance in [0, 1].
  std::vector<glm::vec3> radiance, reflectance;
  ToneCurve tone;
  DirectionMap probe;
};

/// The reflectance at each vertex: its patches', weighted by area.
std::vector<glm::vec3> vertex_reflectance(const LitScene& scene);

}  // namespace gnomon::pipeline
