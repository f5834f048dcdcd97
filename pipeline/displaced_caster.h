// A mesh that casts in another's place lies up to its error above the surface that is drawn, and
// would shadow half of that. So it is moved away from the light (Object::shadow_displace): each
// corner along its own ray, which keeps the outline that the light sees, and with it the shadow on
// everything that is farther behind it than the move.
// Invariant: all methods, and the rays that check them, move by one expression.
#pragma once

#include <memory>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/placed_object.h"
#include "pipeline/scene.h"
#include "pipeline/topology.h"

namespace gnomon::pipeline {

/// Where a corner goes: `distance` away from the light, all in model space (light_in_model). One
/// where the light is stays.
glm::vec4 displaced(const glm::vec4& corner, const glm::dvec4& light_model, double distance);

/// Is what casts moved at all?
bool is_displaced(const Object& object);

/// A copy that is moved anew for each light and frame.
struct MovedCaster {
  std::shared_ptr<const Topology> source;
  Topology topology;
};

/// What casts a shadow of the light: caster_topology, or a copy of it that is moved, in `memory`.
/// Its thickness stays what it was.
const Topology& caster_for(const PlacedObject& object, const glm::vec4& light_world,
                           MovedCaster& memory);

/// The scene whose shadow models, copies, lie where methods take them to be for this light; none is
/// moved again. For rays, which know no light.
Scene displace_casters(Scene scene, const glm::vec4& light_world);

}  // namespace gnomon::pipeline
