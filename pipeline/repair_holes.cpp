// Holes closed with the triangulation of least area (Barequet and Sharir 1995, without their
// angles), or from their middle where that would draw an edge that is there already.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/repair_surface.h"

namespace gnomon::pipeline::repair {
namespace {

using PlacePair = std::pair<std::uint32_t, std::uint32_t>;
/// Corners of a loop, numbered along it, wound like the loop.
using LoopTriangle = std::array<std::size_t, 3>;

/// Edges by places, since a shadow volume welds by position.
std::set<PlacePair> places_joined(const Surface& surface) {
  std::set<PlacePair> joined;
  for (std::uint32_t half = 0; half < 3 * surface.triangles.size(); ++half)
    joined.insert(std::minmax(surface.place[surface.from(half)], surface.place[surface.to(half)]));
  return joined;
}

/// The half-edges without a mate as closed loops, each beginning with its smallest.
std::vector<std::vector<std::uint32_t>> open_loops(const Surface& surface) {
  // A fan of an oriented surface has one open half-edge that leaves its vertex, or none.
  std::vector<std::uint32_t> leaving(surface.positions.size(), kNone);
  for (std::uint32_t half = 0; half < surface.mate.size(); ++half)
    if (surface.mate[half] == kNone) leaving[surface.from(half)] = half;
  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<bool> seen(surface.mate.size(), false);
  for (std::uint32_t first = 0; first < surface.mate.size(); ++first) {
    if (surface.mate[first] != kNone || seen[first]) continue;
    std::vector<std::uint32_t> loop;
    for (std::uint32_t half = first; half != kNone && !seen[half];
         half = leaving[surface.to(half)]) {
      seen[half] = true;
      loop.push_back(half);
    }
    if (surface.to(loop.back()) == surface.from(first)) loops.push_back(std::move(loop));
  }
  return loops;
}

class Hole {
 public:
  Hole(const Surface& surface, const std::vector<std::uint32_t>& loop,
       const std::set<PlacePair>& joined)
      : joined_(joined), n_(loop.size()) {
    for (const std::uint32_t half : loop) {
      at_.push_back(surface.at(surface.from(half)));
      place_.push_back(surface.place[surface.from(half)]);
    }
  }

  /// n - 2 triangles, or nothing where each way draws a forbidden edge.
  std::optional<std::vector<LoopTriangle>> least_area() {
    cost_.assign(n_ * n_, 0.0);
    split_.assign(n_ * n_, 0);
    for (std::size_t span = 2; span < n_; ++span)
      for (std::size_t i = 0; i + span < n_; ++i) choose_split(i, i + span);
    if (!std::isfinite(cost_[n_ - 1])) return std::nullopt;
    std::vector<LoopTriangle> triangles;
    std::vector<PlacePair> waiting{{0, static_cast<std::uint32_t>(n_ - 1)}};
    while (!waiting.empty()) {
      const auto [i, k] = waiting.back();
      waiting.pop_back();
      if (k < i + 2) continue;
      const std::uint32_t j = split_[i * n_ + k];
      triangles.push_back({i, j, k});
      waiting.emplace_back(j, k);
      waiting.emplace_back(i, j);
    }
    return triangles;
  }

 private:
  void choose_split(std::size_t i, std::size_t k) {
    double& best = cost_[i * n_ + k];
    best = std::numeric_limits<double>::infinity();
    // The loop's own last edge is no chord.
    const bool chord = !(i == 0 && k == n_ - 1);
    if (chord && (place_[i] == place_[k] || joined_.contains(std::minmax(place_[i], place_[k]))))
      return;
    for (std::size_t j = i + 1; j < k; ++j) {
      const glm::dvec3 u = at_[j] - at_[i], v = at_[k] - at_[i];
      const double area = glm::length(glm::cross(u, v));
      // One without area is the last resort.
      const double cost = cost_[i * n_ + j] + cost_[j * n_ + k] +
                          (area > 0.0 ? area : 1e6 * (glm::dot(u, u) + glm::dot(v, v)));
      if (cost < best) {
        best = cost;
        split_[i * n_ + k] = static_cast<std::uint32_t>(j);
      }
    }
  }

  const std::set<PlacePair>& joined_;
  std::size_t n_;
  std::vector<glm::dvec3> at_;
  std::vector<std::uint32_t> place_;
  std::vector<double> cost_;
  std::vector<std::uint32_t> split_;
};

/// Adds a triangle against the loop's direction, so that it runs along the loop's edges the other
/// way than the triangles beside it.
void add_filling(Surface& surface, std::array<std::uint32_t, 3> vertex,
                 std::array<std::uint32_t, 3> corner) {
  std::swap(vertex[1], vertex[2]);
  std::swap(corner[1], corner[2]);
  surface.triangles.push_back({.vertex = vertex, .corner = corner, .filling = true});
}

void fill_from_middle(Surface& surface, const std::vector<std::uint32_t>& loop) {
  glm::dvec3 sum(0.0);
  for (const std::uint32_t half : loop) sum += surface.at(surface.from(half));
  const auto middle = static_cast<std::uint32_t>(surface.positions.size());
  surface.positions.emplace_back(sum / static_cast<double>(loop.size()));
  surface.place.push_back(kNone - middle);
  for (const std::uint32_t half : loop) {
    const Triangle& beside = surface.triangles[half / 3];
    const std::uint32_t from_corner = beside.corner[half % 3],
                        to_corner = beside.corner[(half + 1) % 3];
    add_filling(surface, {surface.from(half), surface.to(half), middle},
                {from_corner, to_corner, from_corner});
  }
}

/// The mates of new triangles: each half-edge of theirs meets one other that has none.
void pair_fillings(Surface& surface) {
  surface.mate.resize(3 * surface.triangles.size(), kNone);
  const SurfaceEdges edges = edges_of(surface);
  for (const SurfaceEdges::Edge& edge : edges.edges) {
    std::vector<std::uint32_t> single;
    for (const std::uint32_t half : edges.of(edge))
      if (surface.mate[half] == kNone) single.push_back(half);
    if (single.size() != 2 || surface.from(single[0]) == surface.from(single[1])) continue;
    surface.mate[single[0]] = single[1];
    surface.mate[single[1]] = single[0];
  }
}

}  // namespace

void close_holes(Surface& surface, std::size_t max_hole_edges, MeshRepairReport& report) {
  std::set<PlacePair> joined = places_joined(surface);
  const std::size_t before = surface.triangles.size();
  for (const std::vector<std::uint32_t>& loop : open_loops(surface)) {
    if (loop.size() > max_hole_edges) continue;
    ++report.closed_holes;
    if (loop.size() == 2) {
      surface.mate[loop[0]] = loop[1];
      surface.mate[loop[1]] = loop[0];
      continue;
    }
    const auto triangles = Hole(surface, loop, joined).least_area();
    if (!triangles) {
      fill_from_middle(surface, loop);
      continue;
    }
    for (const LoopTriangle& t : *triangles) {
      std::array<std::uint32_t, 3> vertex{}, corner{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t half = loop[t[k]];
        vertex[k] = surface.from(half);
        corner[k] = surface.triangles[half / 3].corner[half % 3];
      }
      for (std::size_t k = 0; k < 3; ++k)
        joined.insert(std::minmax(surface.place[vertex[k]], surface.place[vertex[(k + 1) % 3]]));
      add_filling(surface, vertex, corner);
    }
  }
  report.hole_triangles += surface.triangles.size() - before;
  pair_fillings(surface);
}

}  // namespace gnomon::pipeline::repair
