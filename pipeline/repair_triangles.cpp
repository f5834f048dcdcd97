// Triangles that a repair removes: repeated corners, repeated triangles, corners on one line.
#include <algorithm>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/repair_surface.h"

namespace gnomon::pipeline::repair {
namespace {

bool has_repeated_corner(const Triangle& t) {
  return t.vertex[0] == t.vertex[1] || t.vertex[1] == t.vertex[2] || t.vertex[2] == t.vertex[0];
}

/// Its corners from the smallest on, in their winding.
std::array<std::uint32_t, 3> wound(const Triangle& t) {
  std::array<std::uint32_t, 3> v = t.vertex;
  std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
  return v;
}

bool is_flat(const Surface& surface, const Triangle& t) {
  const glm::dvec3 a = surface.at(t.vertex[0]);
  return glm::cross(surface.at(t.vertex[1]) - a, surface.at(t.vertex[2]) - a) == glm::dvec3(0.0);
}

std::uint32_t longest_half_edge(const Surface& surface, std::uint32_t t) {
  std::uint32_t longest = 3 * t;
  const auto length = [&](std::uint32_t half) {
    return glm::distance(surface.at(surface.from(half)), surface.at(surface.to(half)));
  };
  for (std::uint32_t half = 3 * t + 1; half < 3 * t + 3; ++half)
    if (length(half) > length(longest)) longest = half;
  return longest;
}

using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

/// Draws the diagonal of the two triangles' quadrangle the other way. False where that edge exists
/// or the two are wound differently.
bool redraw_diagonal(Surface& surface, std::uint32_t half, std::uint32_t across,
                     std::set<VertexPair>& edges) {
  if (surface.from(half) != surface.to(across)) return false;
  const std::uint32_t v = surface.apex(half), d = surface.apex(across);
  if (v == d || edges.contains(std::minmax(v, d))) return false;
  const Triangle flat = surface.triangles[half / 3], other = surface.triangles[across / 3];
  const auto corner = [](const Triangle& t, std::uint32_t at) { return t.corner[at % 3]; };
  // a -> b is the flat triangle's longest edge; the quadrangle runs a, d, b, v.
  const std::uint32_t a = surface.from(half), b = surface.to(half);
  const std::uint32_t a_corner = corner(other, across + 1), b_corner = corner(other, across),
                      d_corner = corner(other, across + 2), v_corner = corner(flat, half + 2);
  edges.erase(std::minmax(a, b));
  edges.insert(std::minmax(v, d));
  surface.triangles[half / 3].vertex = {a, d, v};
  surface.triangles[half / 3].corner = {a_corner, d_corner, v_corner};
  surface.triangles[across / 3].vertex = {d, b, v};
  surface.triangles[across / 3].corner = {d_corner, b_corner, v_corner};
  surface.triangles[half / 3].turned = other.turned;
  return true;
}

}  // namespace

void remove_repeated(Surface& surface, MeshRepairReport& report) {
  report.collapsed_triangles += std::erase_if(surface.triangles, has_repeated_corner);
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> order;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    order.emplace_back(wound(surface.triangles[t]), t);
  std::sort(order.begin(), order.end());
  std::vector<bool> repeated(surface.triangles.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i)
    repeated[order[i].second] = order[i].first == order[i - 1].first;
  std::uint32_t t = 0;
  report.duplicate_triangles +=
      std::erase_if(surface.triangles, [&](const Triangle&) { return repeated[t++]; });
}

void remove_flat(Surface& surface, MeshRepairReport& report) {
  // One triangle's turn may free the next; a mesh that needs more rounds keeps the rest.
  for (int round = 0; round < 8; ++round) {
    const SurfaceEdges all = edges_of(surface);
    std::set<VertexPair> edges;
    std::vector<std::uint32_t> across(3 * surface.triangles.size(), kNone);
    std::vector<std::size_t> uses(across.size(), 0);
    for (const SurfaceEdges::Edge& edge : all.edges) {
      edges.insert({edge.a, edge.b});
      const auto halves = all.of(edge);
      for (const std::uint32_t half : halves) uses[half] = halves.size();
      if (halves.size() != 2) continue;
      across[halves[0]] = halves[1];
      across[halves[1]] = halves[0];
    }
    std::vector<bool> removed(surface.triangles.size(), false), touched = removed;
    std::size_t changes = 0;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      if (touched[t] || !is_flat(surface, surface.triangles[t])) continue;
      const std::uint32_t half = longest_half_edge(surface, t);
      if (uses[half] == 1) {
        removed[t] = true;
      } else if (across[half] == kNone || touched[across[half] / 3] ||
                 !redraw_diagonal(surface, half, across[half], edges)) {
        continue;
      } else {
        touched[across[half] / 3] = true;
      }
      touched[t] = true;
      ++changes;
    }
    std::uint32_t t = 0;
    std::erase_if(surface.triangles, [&](const Triangle&) { return removed[t++]; });
    report.flat_triangles += changes;
    if (changes == 0) return;
  }
}

}  // namespace gnomon::pipeline::repair
