// Cracks closed: vertices of open edges that nearly meet, and those that lie on another open edge.
#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/point_tree.h"
#include "pipeline/repair_surface.h"

namespace gnomon::pipeline::repair {
namespace {

/// Vertices of edges of one triangle, ascending, and a tree of their positions in that order.
struct OpenVertices {
  std::vector<std::uint32_t> vertices;
  PointTree tree;

  static OpenVertices of(const Surface& surface, const SurfaceEdges& edges) {
    std::vector<std::uint32_t> vertices;
    for (const SurfaceEdges::Edge& edge : edges.edges)
      if (edge.end - edge.begin == 1) vertices.insert(vertices.end(), {edge.a, edge.b});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<glm::dvec3> points;
    for (const std::uint32_t v : vertices) points.push_back(surface.at(v));
    return {std::move(vertices), PointTree(std::move(points))};
  }
};

/// The triangles of each vertex.
std::vector<std::vector<std::uint32_t>> triangles_around(const Surface& surface) {
  std::vector<std::vector<std::uint32_t>> around(surface.positions.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
    for (const std::uint32_t v : surface.triangles[t].vertex) around[v].push_back(t);
  return around;
}

}  // namespace

void weld_open_vertices(Surface& surface, double radius, MeshRepairReport& report) {
  const OpenVertices open = OpenVertices::of(surface, edges_of(surface));
  const std::vector<std::vector<std::uint32_t>> around = triangles_around(surface);
  // Each vertex goes to the nearest earlier one that stays, so that it moves once.
  std::vector<std::uint32_t> target(surface.positions.size());
  for (std::uint32_t v = 0; v < target.size(); ++v) target[v] = v;
  const auto share_a_triangle = [&](std::uint32_t v, std::uint32_t to) {
    return std::ranges::any_of(around[v], [&](std::uint32_t t) {
      return std::ranges::any_of(surface.triangles[t].vertex,
                                 [&](std::uint32_t w) { return w != v && target[w] == to; });
    });
  };
  for (const std::uint32_t v : open.vertices) {
    std::pair<double, std::uint32_t> best{radius, kNone};
    for (const std::uint32_t n : open.tree.near_segment(surface.at(v), surface.at(v), radius)) {
      const std::uint32_t w = open.vertices[n];
      if (w >= v || target[w] != w || share_a_triangle(v, w)) continue;
      best = std::min(best, {glm::distance(surface.at(v), surface.at(w)), w});
    }
    if (best.second == kNone) continue;
    target[v] = best.second;
    ++report.welded_vertices;
  }
  for (Triangle& t : surface.triangles)
    for (std::uint32_t& v : t.vertex) v = target[v];
}

void cut_t_junctions(Surface& surface, double radius, MeshRepairReport& report) {
  // A triangle is cut along one edge a round, so three rounds serve all of them.
  for (int round = 0; round < 3; ++round) {
    const SurfaceEdges edges = edges_of(surface);
    const OpenVertices open = OpenVertices::of(surface, edges);
    std::vector<bool> cut(surface.triangles.size(), false);
    std::size_t cuts = 0;
    for (const SurfaceEdges::Edge& edge : edges.edges) {
      if (edge.end - edge.begin != 1) continue;
      const std::uint32_t half = edges.of(edge)[0], number = half / 3;
      if (cut[number]) continue;
      const std::uint32_t a = surface.from(half), b = surface.to(half), c = surface.apex(half);
      const glm::dvec3 at_a = surface.at(a), at_b = surface.at(b);
      std::vector<std::pair<double, std::uint32_t>> on_edge;
      for (const std::uint32_t n : open.tree.near_segment(at_a, at_b, radius)) {
        const std::uint32_t v = open.vertices[n];
        const glm::dvec3 p = surface.at(v);
        if (v == c || glm::distance(p, at_a) <= radius || glm::distance(p, at_b) <= radius)
          continue;
        on_edge.emplace_back(closest_on_segment(p, at_a, at_b), v);
      }
      if (on_edge.empty()) continue;
      std::sort(on_edge.begin(), on_edge.end());
      const Triangle whole = surface.triangles[number];
      const std::uint32_t k = half % 3;
      const std::uint32_t a_corner = whole.corner[k], b_corner = whole.corner[(k + 1) % 3],
                          c_corner = whole.corner[(k + 2) % 3];
      std::pair<std::uint32_t, std::uint32_t> last{a, a_corner};
      on_edge.emplace_back(1.0, b);
      for (std::size_t i = 0; i < on_edge.size(); ++i) {
        const auto [share, v] = on_edge[i];
        // Between the ends a cut keeps what the nearer one has.
        const std::pair<std::uint32_t, std::uint32_t> next{v, share < 0.5 ? a_corner : b_corner};
        Triangle piece = whole;
        piece.vertex = {last.first, next.first, c};
        piece.corner = {last.second, next.second, c_corner};
        if (i == 0)
          surface.triangles[number] = piece;
        else
          surface.triangles.push_back(piece);
        last = next;
      }
      cut[number] = true;
      cuts += on_edge.size() - 1;
    }
    report.t_junctions += cuts;
    if (cuts == 0) return;
  }
}

}  // namespace gnomon::pipeline::repair
