// The surface that mesh_repair works on, and the steps of the repair. Internal to pipeline/.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/mesh_repair.h"

namespace gnomon::pipeline::repair {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
/// The part of the tolerance that is kept for moving copies apart.
inline constexpr double kPartingShare = 1.0 / 16.0;

struct Triangle {
  std::array<std::uint32_t, 3> vertex{};
  /// The model's corner (an index of its parts' indices, counted through the parts) whose normal,
  /// texture coordinates and colour each corner keeps.
  std::array<std::uint32_t, 3> corner{};
  /// Wound the other way than in the model.
  bool turned = false;
  /// Made to close a hole: its normal is its plane's.
  bool filling = false;

  void turn() {
    std::swap(vertex[1], vertex[2]);
    std::swap(corner[1], corner[2]);
    turned = !turned;
  }
};

/// Half-edge 3 t + k runs from corner k of triangle t to the next.
struct Surface {
  std::vector<glm::vec3> positions;
  std::vector<Triangle> triangles;
  /// Before part_fans a vertex is a position. After it each fan of triangles has a vertex of its
  /// own, and this is the one that it was.
  std::vector<std::uint32_t> place;
  /// The half-edge on the other side, or kNone; filled by pair_half_edges.
  std::vector<std::uint32_t> mate;
  /// For each corner of the model the position that it came to; kNone where its triangle is gone.
  std::vector<std::uint32_t> home;

  glm::dvec3 at(std::uint32_t vertex) const { return glm::dvec3(positions[vertex]); }
  std::uint32_t from(std::uint32_t half) const { return triangles[half / 3].vertex[half % 3]; }
  std::uint32_t to(std::uint32_t half) const { return triangles[half / 3].vertex[(half + 1) % 3]; }
  std::uint32_t apex(std::uint32_t half) const {
    return triangles[half / 3].vertex[(half + 2) % 3];
  }
};

/// An undirected edge with its half-edges, ascending.
struct SurfaceEdges {
  struct Edge {
    std::uint32_t a = 0, b = 0, begin = 0, end = 0;
  };
  /// Ascending by (a, b), a < b.
  std::vector<Edge> edges;
  std::vector<std::uint32_t> halves;

  std::span<const std::uint32_t> of(const Edge& edge) const {
    return std::span(halves).subspan(edge.begin, edge.end - edge.begin);
  }
};
SurfaceEdges edges_of(const Surface& surface);

/// The half-edge that follows in the same triangle.
inline std::uint32_t next_in_triangle(std::uint32_t half) {
  return half - half % 3 + (half + 1) % 3;
}

// The steps, in their order. Each adds to the report what it did.

/// Removes triangles with a repeated corner, and those with the corners of an earlier one in the
/// same winding. A triangle and its reverse stay: they are two sides.
void remove_repeated(Surface& surface, MeshRepairReport& report);

/// Moves vertices of open edges onto one within `radius`. Ends of one triangle stay apart.
void weld_open_vertices(Surface& surface, double radius, MeshRepairReport& report);

/// Cuts the triangle of an open edge at the vertices of open edges that lie within `radius` of its
/// inside.
void cut_t_junctions(Surface& surface, double radius, MeshRepairReport& report);

/// Removes triangles whose corners lie on one line: the diagonal of the quadrangle with the
/// neighbour across the longest edge is drawn the other way. What cannot be is left.
void remove_flat(Surface& surface, MeshRepairReport& report);

/// Winds the triangles that hang together by edges of two triangles one way, against as few of them
/// as possible.
void wind_patches(Surface& surface);

/// Finds each half-edge's mate: the only other one, or at edges of more the one across the solid
/// that lies between. Needs wind_patches.
void pair_half_edges(Surface& surface, MeshRepairReport& report);

/// Gives each fan of triangles that hang together around a vertex a vertex of its own.
void part_fans(Surface& surface);

/// Closes loops of at most max_hole_edges half-edges without a mate.
void close_holes(Surface& surface, std::size_t max_hole_edges, MeshRepairReport& report);

/// Cuts edges of vertices that more than two triangles still share (the surface runs into itself
/// there and its fans hang together around both ends) at their middles, all but one pair each.
void cut_shared_edges(Surface& surface, MeshRepairReport& report);

/// Turns closed pieces outwards, except hollows: those that lie inside another closed piece and
/// were wound inwards as they came. Removes closed pieces that repeat another one.
void turn_outwards(Surface& surface, MeshRepairReport& report);

/// Moves copies of vertices by `distance` into their own fan where edges would be welded otherwise.
void part_vertices(Surface& surface, double distance, MeshRepairReport& report);

}  // namespace gnomon::pipeline::repair
