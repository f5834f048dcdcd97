// Shadow volumes extruded in a vertex stage (Kuehl, sections 3.2 and 4.2): a mesh that is built
// once, in which each triangle has corners of its own and each edge is a quad without area between
// two triangles' corners. For a light the vertices of triangles that are turned from it are moved,
// and nothing else changes: quads at the outline become the sides, the triangles are the caps,
// moved or not.
// Invariant: whichever triangles are moved, the extended mesh is a closed 2-chain.
//
// The paper wants two triangles at each edge. Here:
// - Of a mesh whose edges cancel (Topology::closed), however many triangles meet at one, a triangle
//   that runs along the edge one way is joined to one that runs the other way.
// - Any other mesh, and a closed one with the light inside, is taken twice, the second time turned
//   round (both_sides), so that its edges cancel and one of each triangle's two sides faces the
//   light. At an edge of one triangle its two sides are joined, so there always is a quad with
//   area.
// Where there is a choice, sides of similar normals are joined: they mostly move together.
// That is find_silhouette's convention: a triangle casts from either side, an edge is as often in
// the outline as the casting triangles along it do not cancel. Where two volumes share an edge and
// both have it in their outline, in opposite directions, the silhouette leaves it out and here are
// two quads that cancel, as real numbers do: cut along opposite diagonals and snapped, they may
// leave a count where one unit of depth decides.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/shadow_volume.h"
#include "pipeline/topology.h"

namespace gnomon::pipeline {

struct DegenerateQuads {
  /// One a vertex of the extended mesh: its place in Topology::positions. Three a triangle, in the
  /// topology's order; then, for both sides, three a triangle again.
  std::vector<std::uint32_t> positions;
  /// Three a triangle: the triangles, their other sides, two a quad.
  std::shared_ptr<const std::vector<std::uint32_t>> indices;
  bool both_sides = false;
};

/// Precondition: both_sides, or the topology is closed.
DegenerateQuads add_degenerate_quads(const Topology& topology, bool both_sides);

/// The vertex stage: fills `volume` with the extended mesh, whose vertices stay where `casting`
/// (find_casting) says that their triangle, or its other side, faces the light, and go to far_of(v)
/// elsewhere. The indices are shared, not copied. `far` is memory.
template <class FarOf>
void displace(const DegenerateQuads& quads, const Topology& topology,
              std::span<const std::int8_t> casting, FarOf far_of, std::vector<glm::vec4>& far,
              ShadowVolume& volume) {
  far.clear();
  for (const glm::vec4& p : topology.positions) far.push_back(far_of(glm::dvec3(p)));
  const std::size_t corners = topology.indices.size();
  volume.positions.resize(quads.positions.size());
  for (std::size_t i = 0; i < volume.positions.size(); ++i) {
    const int side = i < corners ? 1 : -1;
    const std::uint32_t p = quads.positions[i];
    const bool stays = casting[(i < corners ? i : i - corners) / 3] * side > 0;
    volume.positions[i] = stays ? topology.positions[p] : far[p];
  }
  volume.indices.clear();
  volume.shared_indices = quads.indices;
  volume.front_cap_indices = volume.side_indices = volume.side_positions = 0;
}

}  // namespace gnomon::pipeline
