// A mesh made fit for classical shadow volumes: welded where it is open, wound consistently,
// separated where more than two triangles meet, closed where holes are small.
// Invariant: no vertex moves by more than the tolerance, and only those move that must: vertices of
// open edges onto their neighbours, and copies of a vertex that would be welded again because
// positions are all that a shadow volume goes by.
// Sources: cutting along non-manifold edges after Gueziec, Taubin, Lazarus and Horn 2001; pairs by
// angle around an edge as in Rossignac and Cardoze 1999; holes filled with the least area after
// Barequet and Sharir 1995.
#pragma once

#include <cstddef>

#include "pipeline/mesh.h"

namespace gnomon::pipeline {

struct MeshRepairOptions {
  /// Metres; negative: the default of mesh_tolerance.
  double tolerance_m = -1.0;
  /// Longest hole that is closed; at most kMaxHoleEdges.
  std::size_t max_hole_edges = 32;
};

inline constexpr std::size_t kMaxHoleEdges = 400;

struct MeshRepairReport {
  double tolerance_m = 0.0;
  /// How far the vertex that moved farthest is from where it was.
  double largest_move_m = 0.0;
  /// Triangles left out: with a coordinate that is not finite, with two corners at one position,
  /// with three on one line (their neighbours take over the edge), and repeated ones.
  std::size_t non_finite_triangles = 0, collapsed_triangles = 0, flat_triangles = 0,
              duplicate_triangles = 0;
  /// Vertices of open edges that moved onto a neighbour, and those that cut an open edge they lie
  /// on.
  std::size_t welded_vertices = 0, t_junctions = 0;
  /// Triangles wound the other way than they were.
  std::size_t turned_triangles = 0;
  /// Edges of more than two triangles that were taken apart, and edges that were opened because the
  /// surface has one side only.
  std::size_t parted_edges = 0, cut_edges = 0;
  /// Vertices that were set on the middle of edges where a surface runs into itself.
  std::size_t middle_vertices = 0;
  /// Copies of vertices that moved a sixteenth of the tolerance apart.
  std::size_t parted_vertices = 0;
  /// Outlines closed, and the triangles that it took.
  std::size_t closed_holes = 0, hole_triangles = 0;
};

struct RepairedMesh {
  Model model;
  MeshRepairReport report;
};

/// The model with its parts, materials, normals, texture coordinates and colours; parts that lose
/// every triangle are left out. A triangle that is turned has its normals turned if they are
/// against it. What check_mesh calls a fault is gone afterwards, except open edges of outlines
/// longer than max_hole_edges.
/// Preconditions: three indices a triangle, each below its part's number of positions.
RepairedMesh repair_mesh(const Model& model, const MeshRepairOptions& options = {});

}  // namespace gnomon::pipeline
