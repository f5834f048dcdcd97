// Random closed surfaces: every edge is used as often in one direction as in the other. They need
// not be convex and may cut through themselves.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "random_frames.h"

namespace gnomon::closed_meshes {

/// Homogeneous positions; w = 0 is a point at infinity.
struct ClosedMesh {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;
};

/// A sphere about the origin, of 20 * 4^subdivisions triangles, each vertex moved to a radius in
/// [0.3, 1].
ClosedMesh dented_sphere(random_frames::Random& random, int subdivisions);

/// One of a tetrahedron, a parallelepiped and a dented sphere, in the ball of that radius about the
/// centre.
ClosedMesh random_mesh(random_frames::Random& random, const glm::vec3& centre, float radius);

/// The shadow volumes of the triangles that face the light, each closed on its own: the triangle,
/// its image at infinity as seen from the light, and three sides. light.w = 0: a direction towards
/// the light.
ClosedMesh shadow_volumes(const ClosedMesh& mesh, const glm::vec4& light);

}  // namespace gnomon::closed_meshes
