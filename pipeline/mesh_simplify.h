// A mesh with fewer triangles that a picture cannot tell from the first: edges are collapsed by
// meshoptimizer (Garland and Heckbert 1997) as far as a bound in metres allows, and the result is
// measured and checked, because meshoptimizer's own error is an average over planes and its 0.18
// makes non-manifold edges of some closed meshes (meshoptimizer#699).
// Invariant: the result has no fault (check_mesh) that the model does not have as often, and it was
// measured to lie within the bound.
#pragma once

#include <cstddef>

#include "pipeline/mesh.h"

namespace gnomon::pipeline {

struct MeshSimplifyReport {
  /// The bound, the one that meshoptimizer was finally given, and what was measured
  /// (surface_distance).
  double error_m = 0.0, given_error_m = 0.0, measured_error_m = 0.0;
  std::size_t triangles_before = 0, triangles_after = 0;
  /// Tries that had more faults than the model or lay outside the bound; each was followed by one
  /// with seven tenths of its error.
  std::size_t faulty_tries = 0, distant_tries = 0;
  /// Edges of the result that repair_mesh parted.
  std::size_t parted_edges = 0;
  /// Every try failed: the model came back as it was.
  bool given_up = false;
};

struct SimplifiedMesh {
  Model model;
  MeshSimplifyReport report;
};

/// Each part is simplified for itself, its outline kept, so that parts still meet. A corner keeps
/// the normal and colour of the vertex at its position that fits its triangle best; textures are
/// left out.
/// Preconditions: error_m is positive and finite; three indices a triangle, each below its part's
/// number of positions; every position is finite.
SimplifiedMesh simplify_mesh(const Model& model, double error_m);

/// The length in metres that covers `error_px` pixels at `distance_m` from a camera with that
/// vertical field of view and so many rows.
double metres_of_pixels(double error_px, double distance_m, double fov_y_rad, double rows);

}  // namespace gnomon::pipeline
