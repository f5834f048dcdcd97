// A real scene with the light that was measured in it (Gibson 2003, section 3): what is computed
// once and then serves every frame.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/patches.h"
#include "pipeline/tone_curve.h"

namespace gnomon::pipeline {

/// Radiance from all around a point, as a picture of directions: rows from the top (+y); longitude
/// is pi at the left edge and falls to -pi at the right, where 0 is +z and pi/2 is +x (OpenEXR's
/// latitude-longitude map).
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

/// What patches have at each vertex: its patches' values, weighted by area. `of_patches` is one a
/// patch; a vertex of no patch gets 0.
std::vector<glm::vec3> at_vertices(const PatchModel& model, std::span<const glm::vec3> of_patches);

}  // namespace gnomon::pipeline
