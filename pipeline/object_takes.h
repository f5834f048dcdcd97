// What each shadow of a frame takes from virtual objects, so that they shadow themselves and each
// other (Gibson 2003, section 7.2).
// Invariant: the same for every number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/differential_shadows.h"
#include "pipeline/lit_scene.h"
#include "pipeline/object_light.h"
#include "pipeline/patch_light.h"
#include "pipeline/placed_object.h"

namespace gnomon::pipeline {

/// What one shadow takes from one mesh.
struct MeshTake {
  /// One a vertex, as SourceShadow::colors; without meaning where ObjectTakes has no triangle.
  std::vector<glm::vec4> colors;
  /// Is it more than nothing anywhere?
  bool any = false;
};

struct ObjectTakes {
  /// One a mesh of each object in turn: of a closed one those triangles that the eye may see and
  /// that have a part of a caster before them, of any other all. The same for all shadows, so that
  /// their draws share one set-up.
  std::vector<std::vector<std::uint32_t>> indices;
  /// One a shadow, and in it one a mesh.
  std::vector<std::vector<MeshTake>> of_shadow;
};

/// Fills `result`, whose memory of an earlier frame is used again. A cluster counts as a point, as
/// if all its light came from there: near enough for a vertex that is far from it, and a thousand
/// times less work than all its patches. `radiance` is the objects' own; objects that do not
/// receive get no triangles. A reduced caster counts as before a triangle where it is farther
/// before its plane than it is moved away from the light (Object::shadow_displace).
void take_from_objects(const LitScene& scene, const PatchVisibility& visibility,
                       std::span<const PlacedObject> objects, const ObjectRadiance& radiance,
                       std::span<const SourceShadow> shadows, const glm::vec3& eye_world,
                       const ShadowTakeOptions& options, ObjectTakes& result);

}  // namespace gnomon::pipeline
