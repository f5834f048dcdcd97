// A mesh with few triangles that casts in place of one with many, for shadows that are so soft or
// so many that nobody sees the difference (Gibson 2003, section 7.2: 100 to 500 triangles).
// Invariant: what is drawn and receives stays as it was; only what casts is reduced.
#pragma once

#include <cstddef>
#include <map>
#include <memory>

#include "pipeline/mesh.h"
#include "pipeline/scene.h"

namespace gnomon::pipeline {

struct ReducedOccluder {
  std::shared_ptr<const Model> model;
  /// Measured between the two surfaces (surface_distance), in the model's units.
  double error = 0.0;
};

/// Edges are collapsed by meshoptimizer (Garland and Heckbert 1997) until `triangles` are left, or
/// no more can be without tearing the surface. Parts become one; borders may shrink and faults
/// arise, so it is for maps and volumes that take any mesh. Normals, colours and textures are left
/// out. A model that has so few already, or of which nothing would be left, comes back itself, with
/// an error of 0. Preconditions: triangles is positive; every position is finite; indices are
/// valid.
ReducedOccluder reduce_occluder(const std::shared_ptr<const Model>& model, std::size_t triangles);

/// Reduces models once and keeps them from frame to frame.
class ReducedOccluders {
 public:
  /// 0 leaves every model as it is.
  explicit ReducedOccluders(std::size_t triangles) : triangles_(triangles) {}

  /// Gives casters without a shadow model of their own a reduced one, moved away from the light by
  /// twice its error (pipeline/displaced_caster.h).
  void apply(Scene& scene);

 private:
  std::size_t triangles_;
  std::map<std::shared_ptr<const Model>, ReducedOccluder> known_;
};

}  // namespace gnomon::pipeline
