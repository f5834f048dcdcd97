// Edge adjacency of a caster: triangles over welded vertices, and for each undirected edge the
// triangles that run along it, with their direction. Works for any triangle soup; what a mesh lacks
// of being closed is counted, not refused.
// Invariant: welded positions keep the first index's bits, so what is built from them coincides to
// the bit with the mesh as it is drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/mesh.h"

namespace gnomon::pipeline {

/// One triangle's passage along an edge: +1 from Edge::a to Edge::b, -1 the other way.
struct EdgeUse {
  std::uint32_t triangle = 0;
  int sign = 1;
};

/// An undirected edge, a < b, with its uses in Topology::uses.
struct Edge {
  std::uint32_t a = 0, b = 0;
  std::uint32_t first_use = 0, use_count = 0;
};

/// What a mesh lacks of being a closed, oriented surface.
struct TopologyFaults {
  /// Edges of one triangle only.
  std::size_t boundary_edges = 0;
  /// Edges of more than two triangles.
  std::size_t non_manifold_edges = 0;
  /// Edges of two triangles that run along it in the same direction.
  std::size_t inconsistent_edges = 0;
  /// Edges whose triangles do not cancel (signed sum not 0), of any of the kinds above.
  std::size_t unbalanced_edges = 0;
  /// Triangles left out: a repeated corner or a position that is not finite.
  std::size_t dropped_triangles = 0;
  bool operator==(const TopologyFaults&) const = default;

  bool closed_manifold() const {
    return boundary_edges == 0 && non_manifold_edges == 0 && inconsistent_edges == 0;
  }
};

/// What decides which way each triangle faces, light or no light: its normal cross(b - a, c - a),
/// not of unit length, and its first corner. An array a component.
struct TrianglePlanes {
  std::vector<double> normal_x, normal_y, normal_z;
  std::vector<float> corner_x, corner_y, corner_z;
};

/// The two triangles of an edge that is run once each way: `forward` from Edge::a to Edge::b,
/// `backward` the other way. Both are triangle 0 where an edge is not of that kind.
struct EdgePair {
  std::uint32_t forward = 0, backward = 0;
};

struct Topology {
  std::vector<glm::vec4> positions;
  /// Three a triangle.
  std::vector<std::uint32_t> indices;
  /// One a triangle: its number in the model, counted through the parts from 0.
  std::vector<std::uint32_t> model_triangles;
  /// One a vertex of the model, counted the same way: the place of its position in `positions`.
  std::vector<std::uint32_t> welded;
  std::vector<Edge> edges;
  std::vector<EdgeUse> uses;
  TopologyFaults faults;

  TrianglePlanes planes;
  /// One an edge, and the edges that are no pair, ascending.
  std::vector<EdgePair> pairs;
  std::vector<std::uint32_t> unpaired_edges;
  /// Bounds of all triangles; without one, low is above high.
  glm::dvec3 low{0.0}, high{-1.0};
  /// Of a closed mesh: twice its volume by its area, which is what a plate is thick, and negative
  /// where the mesh is turned inside out; else 0.
  double thickness = 0.0;

  std::size_t triangle_count() const { return indices.size() / 3; }
  std::span<const EdgeUse> uses_of(const Edge& edge) const {
    return std::span(uses).subspan(edge.first_use, edge.use_count);
  }
  /// Every edge's triangles cancel: the triangles bound a volume (perhaps self-touching).
  bool closed() const { return faults.unbalanced_edges == 0; }
};

/// The adjacency of all parts of a model together, welded by position bits (-0 equals +0).
/// Preconditions: three indices a triangle, each below its part's number of positions.
Topology build_topology(const Model& model);

/// To be called when `positions` have moved, those of triangles to finite places: finds planes and
/// bounds anew.
void update_planes(Topology& topology);

/// One sentence that says what a mesh lacks, for a person; empty for a closed manifold.
std::string describe(const TopologyFaults& faults);

/// Topologies of models that are drawn in many frames. Not for use by several threads at once.
class TopologyCache {
 public:
  std::shared_ptr<const Topology> of(const std::shared_ptr<const Model>& model);

 private:
  struct Entry {
    std::shared_ptr<const Model> model;
    std::shared_ptr<const Topology> topology;
  };
  std::vector<Entry> entries_;
};

}  // namespace gnomon::pipeline
