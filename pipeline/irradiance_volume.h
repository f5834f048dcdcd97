// The light that arrives at any point of a room from any side, for shading virtual objects (Greger
// and others 1998): a grid of spherical harmonics of order 2 (Ramamoorthi and Hanrahan 2001).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/bounds.h"
#include "pipeline/lit_scene.h"
#include "pipeline/patch_light.h"

namespace gnomon::pipeline {

/// Coefficients of radiance over directions: l = 0; l = 1, m = -1, 0, 1; l = 2, m = -2 to 2.
using Harmonics = std::array<glm::dvec3, 9>;

/// The nine real harmonics in a direction of unit length.
std::array<double, 9> harmonics(const glm::dvec3& direction);

/// What a surface with this normal receives from radiance with these coefficients: the cosine lobe
/// up to order 2, in which 99 % of it is. Not below 0.
glm::dvec3 irradiance(const Harmonics& radiance, const glm::dvec3& normal);

/// The solid angle of a triangle seen from the origin, positive (Van Oosterom and Strackee 1983).
double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

struct IrradianceVolumeOptions {
  /// Metres between the grid's points at most.
  double spacing_m = 0.4;
  /// The most points along an axis.
  std::size_t longest = 16;
  /// As PatchVisibility::visible_share.
  int samples = 4;
  int threads = 0;
};

class IrradianceVolume {
 public:
  IrradianceVolume(const LitScene& scene, const PatchVisibility& visibility,
                   const IrradianceVolumeOptions& options = {});

  /// Between the grid's eight points, those inside walls and furniture left out; outside the grid
  /// as on its edge. `normal` has unit length.
  glm::dvec3 irradiance(const glm::dvec3& point, const glm::dvec3& normal) const;

  std::size_t points() const { return radiance_.size(); }

 private:
  Harmonics at(const glm::dvec3& point) const;

  Bounds box_;
  std::array<std::size_t, 3> size_{};
  std::vector<Harmonics> radiance_;
  /// 1 where a point is in the open.
  std::vector<double> weight_;
};

}  // namespace gnomon::pipeline
