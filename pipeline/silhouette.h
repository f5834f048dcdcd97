// Which triangles of a caster face a light, and the silhouette between them and the rest (Haller
// 2003, section 3.1.1), as directed edges with an integer multiplicity.
// Invariant: the silhouette is the boundary of the 2-chain of the casting triangles, for any mesh:
// an edge's multiplicity is the signed sum over the casting triangles along it. For a closed
// manifold that is the classical silhouette, each edge once.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "pipeline/topology.h"

namespace gnomon::pipeline {

struct SilhouetteEdge {
  std::uint32_t from = 0, to = 0;
  /// How many casting triangles more run from `from` to `to` than back; positive.
  int multiplicity = 1;
  bool operator==(const SilhouetteEdge&) const = default;
};

struct Silhouette {
  /// One a triangle: +1 it casts as it is oriented, -1 it casts reversed (an open mesh's triangle
  /// that turns its back to the light), 0 it does not cast.
  std::vector<std::int8_t> casting;
  std::vector<SilhouetteEdge> edges;
};

/// The light in the model's own space, in double. w stays 1 for a point; a direction (w = 0) is
/// brought to unit length in the world first, so one unit of it is one metre.
/// Precondition: world_from_model is affine and invertible, the light is finite and no null vector.
glm::dvec4 light_in_model(const glm::vec4& light_world, const glm::mat4& world_from_model);

/// Do triangles that turn their back to the light cast too? Those of a mesh that is not closed, or
/// holds the light.
bool casts_both_sides(const Topology& topology, const glm::dvec4& light_model);

/// Silhouette::casting alone. `both_sides`: see above.
void find_casting(const Topology& topology, const glm::dvec4& light_model, bool both_sides,
                  std::vector<std::int8_t>& casting);

/// The casting triangles and their boundary. One decision a triangle, from the sign of a double
/// determinant; a triangle edge-on to the light does not cast.
/// A closed mesh casts with the triangles that face the light. An open one casts with all: its
/// outline would have holes where a sheet turns its back to the light. So does a closed one
/// with the light inside: the shell keeps it in.
Silhouette find_silhouette(const Topology& topology, const glm::dvec4& light_model);

/// The same into a silhouette whose memory is used again.
void find_silhouette(const Topology& topology, const glm::dvec4& light_model,
                     Silhouette& silhouette);

/// What renderers do that ask for closed manifolds, for comparison: the triangles that face the
/// light cast, and an edge knows two triangles at most (a third is forgotten). It is in the outline
/// where one of them faces the light and the other does not, or where its only one faces the light.
/// For a closed manifold with the light outside this is the silhouette above; for other meshes the
/// volume it makes need not be closed.
void find_classical_silhouette(const Topology& topology, const glm::dvec4& light_model,
                               Silhouette& silhouette);

}  // namespace gnomon::pipeline
