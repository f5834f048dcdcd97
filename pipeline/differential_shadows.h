// What each shadow of a frame takes away, and from where: for each chosen source the point that its
// shadow is cast from, the receivers' triangles that the shadow can fall on, and at their vertices
// what is subtracted (Gibson 2003, sections 7.1.1 and 8).
// Invariant: the same for every number of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/irradiance_volume.h"
#include "pipeline/light_paths.h"
#include "pipeline/light_view.h"

namespace gnomon::pipeline {

/// What is subtracted, and how it is rounded. By share (ShadowTakeOptions) it is a part of what the
/// photograph shows, in steps of 1/255 or in floats; the values below are those of amounts.
enum class ShadowPrecision : std::uint8_t {
  /// Values of the 8-bit picture, each source's rounded when it is subtracted (the paper).
  bytes,
  /// The same with an offset a source in place of rounding to nearest, evenly spread over [0, 1):
  /// of many faint shadows as much is kept, on average, as they have together.
  dithered,
  /// Values in floats, rounded once at the end.
  values,
  /// Radiance in floats, mapped to values at the end: the limit of the model.
  radiance
};

struct ShadowTakeOptions {
  /// Sources that shadows are made for, at most.
  std::size_t passes = 50;
  ShadowPrecision precision = ShadowPrecision::bytes;
  /// A cluster's shadow takes the light of all its sources, as in the paper, and not only of those
  /// that may be hidden.
  bool whole_clusters = false;
  /// A shadow takes a share of the radiance that each pixel shows, so that dark boards of a floor
  /// lose less than light ones and its pattern stays, and shares need no estimate of what other
  /// shadows take; without it, it takes one amount, as in the paper.
  bool by_share = true;
  /// An object gives back the light that its side away from a source sends to where it hides that
  /// source; without it the room sees black objects, as in the paper.
  bool returned_light = true;
  /// As in_first_set.
  double first_share = 0.5;
  int threads = 0;
};

/// One shadow of a frame.
struct SourceShadow {
  SourceCluster cluster;
  /// The brightest source's patch.
  std::uint32_t patch = 0;
  /// Where it is cast from, in the world; w = 1.
  glm::vec4 light{0.0f, 0.0f, 0.0f, 1.0f};
  /// The view from there with the casters in the rectangle, at distances from near_m to far_m.
  LightView view;
  Rectangle casters;
  double near_m = 0.0, far_m = 0.0;
  /// Light of the cluster's sources as one at its point: radiance times area (W / sr).
  glm::vec3 intensity{0.0f};
  /// Of DifferentialShadows::positions: triangles that the shadow can reach; and corners, in the
  /// world, that all it can reach of them lies between.
  std::vector<std::uint32_t> indices;
  std::vector<glm::dvec3> reach;
  /// One a position: what is subtracted, by share a part of its radiance, else values over 255 or
  /// radiance; with a dither's offset, so perhaps below 0; w is 0.
  std::vector<glm::vec4> colors;
  /// One a position: 1 where its light is more than nothing.
  std::vector<std::uint8_t> given;
};

struct DifferentialShadows {
  /// The receivers' vertices.
  std::vector<glm::vec4> positions;
  /// By falling mean transfer.
  std::vector<SourceShadow> shadows;
  /// Rows whose light may be hidden, receivers, and clusters that no shadow can be cast from:
  /// a caster is around their point or too wide for one view.
  std::size_t occluded_sources = 0, receivers = 0, left_out = 0;
};

/// What a caster is to the light of the room.
struct ShadowCaster {
  /// Of its bounds, in the world.
  std::array<glm::dvec3, 8> corners{};
  /// Diffuse, a mean over its parts.
  glm::dvec3 reflectance{0.0};
};

/// `light` is what arrives at the casters.
void find_shadows(const LitScene& scene, const LightPaths& paths, const OccludedLight& occluded,
                  std::span<const ShadowCaster> casters, const IrradianceVolume& light,
                  const ShadowTakeOptions& options, DifferentialShadows& result);

}  // namespace gnomon::pipeline
