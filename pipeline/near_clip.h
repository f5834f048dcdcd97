// May the camera's eye or near plane be inside a caster's shadow volume? Where it may, counting on
// depth pass starts from a wrong number and z-fail is needed (Haller 2003, section 3.1.1, after
// Everitt and Kilgard 2002).
// Invariant: conservative. "No" is a proof; "yes" may be wrong.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/topology.h"

namespace gnomon::pipeline {

/// How a volume is counted: on depth pass as in appendix A, on depth fail, or the former where it
/// is safe and the latter where it is not.
enum class VolumeMethod : std::uint8_t { zpass, zfail, automatic };

/// World-space corners of what lies between the eye and the near plane: the eye and the near
/// rectangle. Absent for a camera without an eye (parallel projection) or a matrix that has no
/// inverse.
struct NearRegion {
  std::vector<glm::dvec3> corners;
};

/// From the inverse, in double, of an OpenGL clip matrix. Methods draw with depth clamp, so what
/// lies in front of the near plane is not cut off: the region reaches to the eye.
std::optional<NearRegion> near_region(const glm::mat4& clip_from_world);

/// May the volume of this caster (infinite, hence any) touch the region?
/// A point q of the region is in shadow only if the way from q to the light meets the caster, so
/// the volume is clear of the region when a plane separates the caster from the hull of the region
/// and the light (region swept towards the light, for a direction). Planes tried: those through the
/// faces of that hull.
bool volume_may_touch(const NearRegion& region, const glm::vec4& light_world,
                      const Topology& caster, const glm::mat4& world_from_model);

/// zpass or zfail. An absent region counts as touched.
VolumeMethod choose_method(VolumeMethod wanted, const std::optional<NearRegion>& region,
                           const glm::vec4& light_world, const Topology& caster,
                           const glm::mat4& world_from_model);

}  // namespace gnomon::pipeline
