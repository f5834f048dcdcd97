// What a mesh lacks of casting a classical shadow volume (every edge shared by two triangles that
// run along it in opposite directions), and what else in it deserves a look, with places.
// Invariant: the verdict is the one of build_topology, which the shadow methods use: vertices are
// one where their positions have the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/mesh.h"

namespace gnomon::pipeline {

/// The tolerance of checks and repairs that are given none, as a part of the bounding box's
/// diagonal.
inline constexpr double kDefaultRelativeTolerance = 1e-5;

/// Numbers of triangles and vertices count through the model's parts from 0, in their order.
struct MeshPlace {
  std::vector<std::uint32_t> triangles, vertices;
  /// Position of each of the vertices, in metres.
  std::vector<glm::vec3> positions_m;
};

/// How often something was found, and where first (ascending by triangle or vertex).
struct MeshFinding {
  std::size_t count = 0;
  std::vector<MeshPlace> first;
};

struct MeshCheckOptions {
  /// Distance up to which vertices count as meant to be one; negative: kDefaultRelativeTolerance of
  /// the diagonal.
  double tolerance_m = -1.0;
  /// Places to keep of each finding.
  std::size_t places = 5;
  /// Look for triangles that cut each other, which takes longer than all the rest.
  bool self_intersections = true;
};

struct MeshCheck {
  /// Triangles and vertices of the model as it is.
  std::size_t triangles = 0, vertices = 0;
  /// Of its usable triangles: vertices with different positions, edges, and pieces that hang
  /// together by edges.
  std::size_t welded_vertices = 0, edges = 0, pieces = 0;
  double diagonal_m = 0.0, tolerance_m = 0.0;

  // A classical volume needs each of these to be 0.
  /// Edges of one triangle: vertices are the ends.
  MeshFinding open_edges;
  /// Edges of three triangles or more.
  MeshFinding non_manifold_edges;
  /// Edges of two triangles that run along it in the same direction.
  MeshFinding misoriented_edges;
  /// Vertices with a coordinate that is no finite number.
  MeshFinding non_finite_vertices;

  // Notes: these alone do not hinder a volume.
  /// Runs of open edges that hang together (holes, or outlines of sheets), with all their vertices.
  MeshFinding outlines;
  std::size_t longest_outline = 0;
  /// Triangles without area: two corners at one position, or all three on one line.
  MeshFinding degenerate_triangles;
  /// Triangles with the corners of an earlier one (the second in the place), wound either way.
  MeshFinding duplicate_triangles;
  /// Vertices at the bits of an earlier one: one vertex to a shadow volume.
  std::size_t repeated_vertices = 0;
  /// Vertices of open edges within the tolerance of another one (the second): meant to be one?
  MeshFinding unwelded_vertices;
  /// A vertex (the first) of an open edge within the tolerance of the inside of another open edge
  /// (the second and third).
  MeshFinding t_junctions;
  MeshFinding unreferenced_vertices;
  /// Vertices where parts of the surface meet that share no edge there.
  MeshFinding touching_vertices;
  /// Closed pieces whose triangles face inwards: hollows, or bodies inside out.
  MeshFinding inward_pieces;
  /// Pairs of triangles that share no vertex and cut or touch each other. Rounded, hence a note.
  MeshFinding self_intersections;
  bool self_intersections_sought = false;

  /// Every edge is shared by two triangles in opposite directions, and there is one.
  bool casts_classical_volume() const;
  /// V - E + F over the usable triangles: 2 (1 - genus) for a closed manifold of one piece.
  long long euler_characteristic = 0;
};

/// Preconditions: three indices a triangle, each below its part's number of positions.
MeshCheck check_mesh(const Model& model, const MeshCheckOptions& options = {});

/// Some kind of edge that a classical volume cannot have is more frequent in `check`.
bool has_more_faults(const MeshCheck& check, const MeshCheck& than);

/// The tolerance in metres: `tolerance_m`, or the default where that is negative; at least 32 steps
/// of the float with the model's largest coordinate, since nothing smaller can be told apart there.
double mesh_tolerance(const Model& model, double tolerance_m);

/// One sentence that says what stops a classical volume; empty if nothing does.
std::string describe(const MeshCheck& check);

}  // namespace gnomon::pipeline
