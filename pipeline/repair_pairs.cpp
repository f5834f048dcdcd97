// Winding, mates and fans: a soup of triangles becomes an oriented surface that two triangles share
// each edge of.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/disjoint_sets.h"
#include "pipeline/repair_surface.h"

namespace gnomon::pipeline::repair {
namespace {

/// A half-edge at an edge of many: the angle of its triangle around the edge, from a to b, and
/// whether it runs that way.
struct Around {
  double angle = 0.0;
  bool backward = false;
  std::uint32_t half = 0;
  /// At one angle those that end a solid come before those that begin one, so that a wall that two
  /// solids share is not paired with itself.
  bool operator<(const Around& other) const {
    return std::tie(angle, backward, half) < std::tie(other.angle, other.backward, other.half);
  }
};

std::vector<Around> sorted_around(const Surface& surface, const SurfaceEdges::Edge& edge,
                                  std::span<const std::uint32_t> halves) {
  const glm::dvec3 a = surface.at(edge.a), axis = glm::normalize(surface.at(edge.b) - a);
  const glm::dvec3 other = std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
  std::vector<Around> around;
  for (const std::uint32_t half : halves) {
    const glm::dvec3 r = surface.at(surface.apex(half)) - a;
    around.push_back(
        {std::atan2(glm::dot(r, v), glm::dot(r, u)), surface.from(half) != edge.a, half});
  }
  std::sort(around.begin(), around.end());
  return around;
}

}  // namespace

SurfaceEdges edges_of(const Surface& surface) {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> order;
  order.reserve(3 * surface.triangles.size());
  for (std::uint32_t half = 0; half < 3 * surface.triangles.size(); ++half) {
    const std::uint32_t a = surface.from(half), b = surface.to(half);
    order.emplace_back(std::min(a, b), std::max(a, b), half);
  }
  std::sort(order.begin(), order.end());
  SurfaceEdges out;
  out.halves.reserve(order.size());
  for (const auto& [a, b, half] : order) {
    const auto at = static_cast<std::uint32_t>(out.halves.size());
    if (out.edges.empty() || out.edges.back().a != a || out.edges.back().b != b)
      out.edges.push_back({a, b, at, at});
    out.halves.push_back(half);
    ++out.edges.back().end;
  }
  return out;
}

void wind_patches(Surface& surface) {
  const SurfaceEdges edges = edges_of(surface);
  std::vector<std::uint32_t> across(3 * surface.triangles.size(), kNone);
  for (const SurfaceEdges::Edge& edge : edges.edges) {
    const auto halves = edges.of(edge);
    if (halves.size() != 2) continue;
    across[halves[0]] = halves[1];
    across[halves[1]] = halves[0];
  }
  constexpr std::uint8_t kUnknown = 2;
  std::vector<std::uint8_t> turn(surface.triangles.size(), kUnknown);
  std::vector<std::uint32_t> patch;
  for (std::uint32_t first = 0; first < surface.triangles.size(); ++first) {
    if (turn[first] != kUnknown) continue;
    patch.assign(1, first);
    turn[first] = 0;
    std::size_t turned = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const std::uint32_t t = patch[i];
      turned += turn[t];
      for (std::uint32_t half = 3 * t; half < 3 * t + 3; ++half) {
        if (across[half] == kNone) continue;
        const std::uint32_t neighbour = across[half] / 3;
        if (turn[neighbour] != kUnknown) continue;
        const bool same_way = surface.from(half) == surface.from(across[half]);
        turn[neighbour] = same_way ? 1 - turn[t] : turn[t];
        patch.push_back(neighbour);
      }
    }
    const std::uint8_t wrong = 2 * turned > patch.size() ? 0 : 1;
    for (const std::uint32_t t : patch)
      if (turn[t] == wrong) surface.triangles[t].turn();
  }
}

void pair_half_edges(Surface& surface, MeshRepairReport& report) {
  const SurfaceEdges edges = edges_of(surface);
  surface.mate.assign(3 * surface.triangles.size(), kNone);
  const auto pair = [&](std::uint32_t a, std::uint32_t b) {
    surface.mate[a] = b;
    surface.mate[b] = a;
  };
  for (const SurfaceEdges::Edge& edge : edges.edges) {
    const std::span<const std::uint32_t> halves = edges.of(edge);
    if (halves.size() == 2) {
      if (surface.from(halves[0]) != surface.from(halves[1]))
        pair(halves[0], halves[1]);
      else
        ++report.cut_edges;
      continue;
    }
    if (halves.size() < 2) continue;
    ++report.parted_edges;
    // With the angle growing, the inside of a solid lies behind a triangle that runs backward along
    // the edge and before one that runs forward: brackets, on a circle.
    const std::vector<Around> around = sorted_around(surface, edge, halves);
    std::vector<std::uint32_t> begun;
    for (std::size_t i = 0; i < 2 * around.size(); ++i) {
      const Around& use = around[i % around.size()];
      if (use.backward) {
        if (i < around.size()) begun.push_back(use.half);
      } else if (surface.mate[use.half] == kNone && !begun.empty()) {
        pair(begun.back(), use.half);
        begun.pop_back();
      }
    }
  }
}

void part_fans(Surface& surface) {
  DisjointSets corners(3 * surface.triangles.size());
  for (std::uint32_t half = 0; half < surface.mate.size(); ++half) {
    const std::uint32_t mate = surface.mate[half];
    if (mate == kNone || mate < half) continue;
    corners.unite(half, next_in_triangle(mate));
    corners.unite(next_in_triangle(half), mate);
  }
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> place, fan(3 * surface.triangles.size(), kNone);
  for (std::uint32_t c = 0; c < fan.size(); ++c) {
    const std::uint32_t root = corners.find(c), old = surface.triangles[c / 3].vertex[c % 3];
    if (root == c) {
      fan[c] = static_cast<std::uint32_t>(positions.size());
      positions.push_back(surface.positions[old]);
      place.push_back(old);
    } else {
      fan[c] = fan[root];
    }
  }
  for (std::uint32_t c = 0; c < fan.size(); ++c) surface.triangles[c / 3].vertex[c % 3] = fan[c];
  surface.positions = std::move(positions);
  surface.place = std::move(place);
}

namespace {

/// Cuts the triangle of a half-edge a -> b at m: it becomes (a, m, c), and (m, b, c) is added with
/// the same numbers of corners. Returns the half-edge m -> b.
std::uint32_t cut_triangle(Surface& surface, std::uint32_t half, std::uint32_t m) {
  const std::uint32_t t = half / 3, k = half % 3;
  const std::uint32_t k1 = (k + 1) % 3, k2 = (k + 2) % 3;
  const auto added = static_cast<std::uint32_t>(surface.triangles.size());
  Triangle rest = surface.triangles[t];
  rest.vertex[k] = m;
  surface.triangles[t].vertex[k1] = m;
  surface.triangles.push_back(rest);
  surface.mate.resize(3 * surface.triangles.size(), kNone);
  const std::uint32_t outer = surface.mate[3 * t + k1];
  surface.mate[3 * added + k1] = outer;
  if (outer != kNone) surface.mate[outer] = 3 * added + k1;
  surface.mate[3 * t + k1] = 3 * added + k2;
  surface.mate[3 * added + k2] = 3 * t + k1;
  return 3 * added + k;
}

}  // namespace

void cut_shared_edges(Surface& surface, MeshRepairReport& report) {
  // A triangle is cut along one edge a round and a triangle's neighbours wait for it, so a few
  // rounds serve all of them.
  for (int round = 0; round < 16; ++round) {
    const SurfaceEdges edges = edges_of(surface);
    std::vector<bool> cut(surface.triangles.size(), false);
    std::size_t cuts = 0;
    for (const SurfaceEdges::Edge& edge : edges.edges) {
      const std::span<const std::uint32_t> halves = edges.of(edge);
      const auto is_first = [&](std::uint32_t half) {
        return half == halves[0] || surface.mate[half] == halves[0];
      };
      for (const std::uint32_t half : halves) {
        const std::uint32_t mate = surface.mate[half];
        if (is_first(half) || (mate != kNone && mate < half)) continue;
        // Triangles that this round has added wait for the next one too.
        const auto is_cut = [&](std::uint32_t h) { return h / 3 >= cut.size() || cut[h / 3]; };
        if (is_cut(half) || (mate != kNone && is_cut(mate))) continue;
        const auto m = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.emplace_back(0.5 * (surface.at(edge.a) + surface.at(edge.b)));
        surface.place.push_back(kNone - m);
        cut[half / 3] = true;
        const std::uint32_t rest = cut_triangle(surface, half, m);
        if (mate != kNone) {
          cut[mate / 3] = true;
          const std::uint32_t mate_rest = cut_triangle(surface, mate, m);
          surface.mate[half] = mate_rest;
          surface.mate[mate_rest] = half;
          surface.mate[rest] = mate;
          surface.mate[mate] = rest;
        }
        ++cuts;
      }
    }
    report.middle_vertices += cuts;
    if (cuts == 0) return;
  }
}

}  // namespace gnomon::pipeline::repair
