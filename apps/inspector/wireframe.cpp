#include "apps/inspector/wireframe.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "apps/inspector/mesh_parts.h"
#include "raster/trace_draw.h"

namespace gnomon::apps::inspector {

namespace {

EdgeKind kind_of(std::string_view part) {
  if (part == "front cap") return EdgeKind::front_cap;
  if (part == "sides") return EdgeKind::side;
  if (part == "back cap") return EdgeKind::back_cap;
  return EdgeKind::mesh;
}

auto key(const WireEdge& edge) { return std::tuple(edge.kind, edge.x0, edge.y0, edge.x1, edge.y1); }

WireEdge edge_between(const raster::SnappedVertex& a, const raster::SnappedVertex& b,
                      EdgeKind kind) {
  WireEdge edge{a.x_fx, a.y_fx, b.x_fx, b.y_fx, kind};
  if (std::pair(edge.x0, edge.y0) > std::pair(edge.x1, edge.y1)) {
    std::swap(edge.x0, edge.x1);
    std::swap(edge.y0, edge.y1);
  }
  return edge;
}

/// Which triangles of the sides begin with a silhouette edge: all but the second ones of quads,
/// which begin with the first and the third corner of the one before.
std::vector<bool> begins_with_silhouette(const raster::Draw& draw) {
  const auto& indices = draw.mesh.indices;
  std::vector<bool> begins(indices.size() / 3, false);
  for (std::size_t t = 0; t < begins.size(); ++t) {
    if (part_of(draw, static_cast<std::uint32_t>(t)) != "sides") continue;
    const bool second = t > 0 && begins[t - 1] && indices[3 * t] == indices[3 * t - 3] &&
                        indices[3 * t + 1] == indices[3 * t - 1];
    begins[t] = !second;
  }
  return begins;
}

/// Which corner of the set-up triangle the mesh triangle's second one is; the first stays the
/// first.
std::size_t second_corner(const raster::SetupTriangle& triangle) {
  return triangle.swapped ? 2 : 1;
}

}  // namespace

std::vector<WireEdge> wireframe(const raster::Draw& draw, const raster::Targets& targets) {
  const raster::DrawTrace trace(draw, targets);
  const std::vector<bool> begins =
      draw.parts.empty() ? std::vector<bool>() : begins_with_silhouette(draw);
  std::vector<WireEdge> edges;
  trace.for_each_triangle([&](const raster::SetupTriangle& triangle) {
    const std::uint32_t number = triangle.first_index / 3;
    const EdgeKind kind = kind_of(part_of(draw, number));
    const auto& v = triangle.vertices;
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(edge_between(v[k], v[(k + 1) % 3], kind));
    if (!begins.empty() && begins[number] && triangle.piece == raster::SetupTriangle::kWhole)
      edges.push_back(edge_between(v[0], v[second_corner(triangle)], EdgeKind::silhouette));
  });
  std::ranges::sort(edges, {}, key);
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const WireEdge& a, const WireEdge& b) { return key(a) == key(b); }),
              edges.end());
  return edges;
}

}  // namespace gnomon::apps::inspector
