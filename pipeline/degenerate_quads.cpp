#include "pipeline/degenerate_quads.h"

#include <utility>

#include <glm/geometric.hpp>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// Sides an edge that are matched by their normals; of more, in their order.
constexpr std::size_t kMostMatched = 16;

/// One side of a triangle.
struct Side {
  std::uint32_t triangle = 0;
  bool other = false;
};

class Builder {
 public:
  Builder(const Topology& topology, bool both_sides)
      : topology_(topology), both_sides_(both_sides) {}

  std::vector<std::uint32_t> indices() {
    add_triangles();
    for (const Edge& edge : topology_.edges) join(edge);
    return std::move(indices_);
  }

 private:
  std::uint32_t corner(const Side& side, std::size_t k) const {
    const std::size_t first = side.other ? topology_.indices.size() : 0;
    return static_cast<std::uint32_t>(first + 3 * std::size_t{side.triangle} + k);
  }
  std::uint32_t corner_at(const Side& side, std::uint32_t position) const {
    const std::uint32_t* at = &topology_.indices[3 * std::size_t{side.triangle}];
    return corner(side, at[0] == position ? 0 : at[1] == position ? 1 : 2);
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    indices_.insert(indices_.end(), {a, b, c});
  }

  void add_triangles() {
    const auto count = static_cast<std::uint32_t>(topology_.triangle_count());
    for (std::uint32_t t = 0; t < count; ++t) add(corner({t}, 0), corner({t}, 1), corner({t}, 2));
    if (!both_sides_) return;
    for (std::uint32_t t = 0; t < count; ++t)
      add(corner({t, true}, 0), corner({t, true}, 2), corner({t, true}, 1));
  }

  /// The quad between a side that runs from edge.a to edge.b and one that runs back. Cut along the
  /// diagonal that extruded silhouettes have, whichever of the two is moved.
  void add_quad(const Edge& edge, const Side& forward, const Side& backward) {
    const std::uint32_t a = corner_at(forward, edge.a), b = corner_at(forward, edge.b);
    const std::uint32_t back_a = corner_at(backward, edge.a), back_b = corner_at(backward, edge.b);
    add(b, a, back_a);
    add(b, back_a, back_b);
  }

  glm::dvec3 normal(const Side& side) const {
    const TrianglePlanes& planes = topology_.planes;
    const glm::dvec3 across(planes.normal_x[side.triangle], planes.normal_y[side.triangle],
                            planes.normal_z[side.triangle]);
    const double length = glm::length(across);
    if (!(length > 0.0)) return glm::dvec3(0.0);
    return across * ((side.other ? -1.0 : 1.0) / length);
  }

  /// Joins the edge's sides in pairs that run against each other.
  void join(const Edge& edge) {
    forward_.clear();
    backward_.clear();
    for (const EdgeUse& use : topology_.uses_of(edge)) {
      (use.sign > 0 ? forward_ : backward_).push_back({use.triangle});
      if (both_sides_) (use.sign > 0 ? backward_ : forward_).push_back({use.triangle, true});
    }
    for (std::size_t i = 0; i < forward_.size(); ++i) {
      if (forward_.size() > 1 && forward_.size() <= kMostMatched) swap_likest_to(i);
      add_quad(edge, forward_[i], backward_[i]);
    }
  }

  /// Moves the two sides of most similar normals, of those from place i on, to place i.
  void swap_likest_to(std::size_t i) {
    std::size_t best_f = i, best_b = i;
    double best = -2.0;
    for (std::size_t f = i; f < forward_.size(); ++f) {
      for (std::size_t b = i; b < backward_.size(); ++b) {
        const double likeness = glm::dot(normal(forward_[f]), normal(backward_[b]));
        if (!(likeness > best)) continue;
        best = likeness;
        best_f = f;
        best_b = b;
      }
    }
    std::swap(forward_[i], forward_[best_f]);
    std::swap(backward_[i], backward_[best_b]);
  }

  const Topology& topology_;
  const bool both_sides_;
  std::vector<std::uint32_t> indices_;
  std::vector<Side> forward_, backward_;
};

}  // namespace

DegenerateQuads add_degenerate_quads(const Topology& topology, bool both_sides) {
  raster::require(both_sides || topology.closed(), "an open mesh is extended on both sides");
  DegenerateQuads quads;
  quads.both_sides = both_sides;
  quads.positions = topology.indices;
  if (both_sides)
    quads.positions.insert(quads.positions.end(), topology.indices.begin(), topology.indices.end());
  quads.indices =
      std::make_shared<const std::vector<std::uint32_t>>(Builder(topology, both_sides).indices());
  return quads;
}

}  // namespace gnomon::pipeline
