#include "pipeline/mesh_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/disjoint_sets.h"
#include "pipeline/finite.h"
#include "pipeline/point_tree.h"
#include "pipeline/self_intersection.h"
#include "pipeline/topology.h"

namespace gnomon::pipeline {
namespace {

/// The box around the finite positions that triangles use; low above high without one.
struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

Box box_of(const Model& model) {
  Box box;
  for (const Part& part : model.parts) {
    for (const std::uint32_t index : part.mesh.indices) {
      const glm::vec4& position = part.mesh.positions[index];
      if (!is_finite(glm::vec3(position))) continue;
      box.low = glm::min(box.low, glm::dvec3(position));
      box.high = glm::max(box.high, glm::dvec3(position));
    }
  }
  return box;
}

double diagonal_of(const Box& box) {
  return box.low.x <= box.high.x ? glm::distance(box.low, box.high) : 0.0;
}

double tolerance_of(const Box& box, double tolerance_m) {
  if (!(box.low.x <= box.high.x)) return std::max(tolerance_m, 0.0);
  const glm::dvec3 far = glm::max(glm::abs(box.low), glm::abs(box.high));
  const auto largest = static_cast<float>(std::max({far.x, far.y, far.z}));
  // Downwards, where there always is one.
  const double step = largest - std::nextafter(largest, 0.0f);
  return std::max(tolerance_m < 0.0 ? kDefaultRelativeTolerance * diagonal_of(box) : tolerance_m,
                  32.0 * step);
}

class Checker {
 public:
  Checker(const Model& model, const MeshCheckOptions& options)
      : model_(model), options_(options), topology_(build_topology(model)) {}

  MeshCheck run() {
    const Box box = box_of(model_);
    check_.diagonal_m = diagonal_of(box);
    check_.tolerance_m = tolerance_of(box, options_.tolerance_m);
    check_.edges = topology_.edges.size();
    look_at_vertices();
    look_at_triangles();
    look_at_edges();
    look_at_pieces();
    look_at_fans();
    look_at_outlines();
    look_at_cracks();
    if (options_.self_intersections) look_at_intersections();
    return std::move(check_);
  }

 private:
  void add(MeshFinding& finding, std::vector<std::uint32_t> triangles,
           std::vector<std::uint32_t> vertices) {
    ++finding.count;
    if (finding.first.size() >= options_.places) return;
    MeshPlace place{std::move(triangles), std::move(vertices), {}};
    for (const std::uint32_t v : place.vertices) place.positions_m.push_back(source_position(v));
    finding.first.push_back(std::move(place));
  }

  glm::vec3 source_position(std::uint32_t vertex) const {
    std::size_t i = vertex;
    for (const Part& part : model_.parts) {
      if (i < part.mesh.positions.size()) return glm::vec3(part.mesh.positions[i]);
      i -= part.mesh.positions.size();
    }
    return glm::vec3(0.0f);
  }

  glm::dvec3 at(std::uint32_t welded) const { return glm::dvec3(topology_.positions[welded]); }
  std::uint32_t model_triangle(std::uint32_t t) const { return topology_.model_triangles[t]; }

  std::vector<std::uint32_t> triangles_of(const Edge& edge) const {
    std::vector<std::uint32_t> triangles;
    for (const EdgeUse& use : topology_.uses_of(edge))
      triangles.push_back(model_triangle(use.triangle));
    return triangles;
  }

  void look_at_vertices() {
    std::vector<bool> used, seen(topology_.positions.size(), false);
    std::size_t base = 0;
    for (const Part& part : model_.parts) {
      used.resize(base + part.mesh.positions.size(), false);
      for (const std::uint32_t index : part.mesh.indices) used[base + index] = true;
      base += part.mesh.positions.size();
    }
    check_.vertices = base;
    first_source_.assign(topology_.positions.size(), 0);
    for (std::uint32_t v = 0; v < base; ++v) {
      const std::uint32_t w = topology_.welded[v];
      if (!is_finite(glm::vec3(topology_.positions[w]))) add(check_.non_finite_vertices, {}, {v});
      if (!used[v]) {
        add(check_.unreferenced_vertices, {}, {v});
        continue;
      }
      if (seen[w])
        ++check_.repeated_vertices;
      else
        first_source_[w] = v;
      seen[w] = true;
    }
  }

  void look_at_triangles() {
    std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> corners;
    std::size_t base = 0;
    for (const Part& part : model_.parts) {
      const std::vector<std::uint32_t>& indices = part.mesh.indices;
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const auto triangle = static_cast<std::uint32_t>(check_.triangles++);
        std::array<std::uint32_t, 3> source{}, welded{};
        bool all_finite = true;
        for (std::size_t k = 0; k < 3; ++k) {
          source[k] = static_cast<std::uint32_t>(base + indices[i + k]);
          welded[k] = topology_.welded[source[k]];
          all_finite = all_finite && is_finite(glm::vec3(topology_.positions[welded[k]]));
        }
        if (!all_finite) continue;
        const glm::dvec3 cross =
            glm::cross(at(welded[1]) - at(welded[0]), at(welded[2]) - at(welded[0]));
        if (cross == glm::dvec3(0.0))
          add(check_.degenerate_triangles, {triangle}, {source[0], source[1], source[2]});
        std::sort(welded.begin(), welded.end());
        if (welded[0] != welded[1] && welded[1] != welded[2])
          corners.emplace_back(welded, triangle);
      }
      base += part.mesh.positions.size();
    }
    std::sort(corners.begin(), corners.end());
    // Triangle and the first one with the same corners; sorted once more so that places ascend.
    std::vector<std::array<std::uint32_t, 5>> repeated;
    for (std::size_t i = 1, first = 0; i < corners.size(); ++i) {
      const std::array<std::uint32_t, 3>& c = corners[i].first;
      if (c == corners[first].first)
        repeated.push_back({corners[i].second, corners[first].second, c[0], c[1], c[2]});
      else
        first = i;
    }
    std::sort(repeated.begin(), repeated.end());
    for (const auto& [triangle, earlier, a, b, c] : repeated)
      add(check_.duplicate_triangles, {triangle, earlier},
          {first_source_[a], first_source_[b], first_source_[c]});
  }

  void look_at_edges() {
    for (const Edge& edge : topology_.edges) {
      const std::span<const EdgeUse> uses = topology_.uses_of(edge);
      const std::vector<std::uint32_t> ends{first_source_[edge.a], first_source_[edge.b]};
      if (uses.size() == 1) {
        add(check_.open_edges, triangles_of(edge), ends);
        open_.push_back(edge);
      } else if (uses.size() > 2) {
        add(check_.non_manifold_edges, triangles_of(edge), ends);
      } else if (uses[0].sign == uses[1].sign) {
        add(check_.misoriented_edges, triangles_of(edge), ends);
      }
    }
  }

  /// Pieces hang together by edges; a piece is closed if each of its edges is an opposite pair.
  void look_at_pieces() {
    const std::size_t count = topology_.triangle_count();
    DisjointSets sets(count);
    for (const Edge& edge : topology_.edges) {
      const std::span<const EdgeUse> uses = topology_.uses_of(edge);
      for (const EdgeUse& use : uses) sets.unite(uses[0].triangle, use.triangle);
    }
    std::vector<double> volume6(count, 0.0);
    std::vector<bool> open(count, false);
    for (const std::uint32_t e : topology_.unpaired_edges)
      open[sets.find(topology_.uses_of(topology_.edges[e])[0].triangle)] = true;
    const glm::dvec3 middle = 0.5 * (topology_.low + topology_.high);
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t* c = &topology_.indices[3 * t];
      volume6[sets.find(t)] +=
          glm::dot(at(c[0]) - middle, glm::cross(at(c[1]) - middle, at(c[2]) - middle));
    }
    std::vector<bool> vertex_used(topology_.positions.size(), false);
    for (const std::uint32_t w : topology_.indices) vertex_used[w] = true;
    check_.welded_vertices =
        static_cast<std::size_t>(std::count(vertex_used.begin(), vertex_used.end(), true));
    for (std::uint32_t t = 0; t < count; ++t) {
      if (sets.find(t) != t) continue;
      ++check_.pieces;
      if (!open[t] && volume6[t] < 0.0)
        add(check_.inward_pieces, {model_triangle(t)}, {first_source_[topology_.indices[3 * t]]});
    }
    check_.euler_characteristic = static_cast<long long>(check_.welded_vertices) -
                                  static_cast<long long>(check_.edges) +
                                  static_cast<long long>(count);
  }

  /// Corners of a vertex that hang together by edges are one fan; a vertex with two is touched.
  void look_at_fans() {
    DisjointSets corners(topology_.indices.size());
    const auto corner_at = [&](std::uint32_t triangle, std::uint32_t vertex) {
      std::uint32_t corner = 3 * triangle;
      while (topology_.indices[corner] != vertex) ++corner;
      return corner;
    };
    for (const Edge& edge : topology_.edges) {
      const std::span<const EdgeUse> uses = topology_.uses_of(edge);
      for (const std::uint32_t end : {edge.a, edge.b})
        for (const EdgeUse& use : uses.subspan(1))
          corners.unite(corner_at(uses[0].triangle, end), corner_at(use.triangle, end));
    }
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> fan(topology_.positions.size(), kNone);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> touching;
    for (std::uint32_t c = 0; c < topology_.indices.size(); ++c) {
      const std::uint32_t w = topology_.indices[c], root = corners.find(c);
      if (fan[w] == kNone) fan[w] = root;
      if (fan[w] != root && root == c) touching.emplace_back(w, c);
    }
    std::sort(touching.begin(), touching.end());
    for (std::size_t i = 0; i < touching.size(); ++i) {
      const auto [w, corner] = touching[i];
      if (i > 0 && touching[i - 1].first == w) continue;
      add(check_.touching_vertices, {model_triangle(fan[w] / 3), model_triangle(corner / 3)},
          {first_source_[w]});
    }
  }

  void look_at_outlines() {
    DisjointSets sets(topology_.positions.size());
    for (const Edge& edge : open_) sets.unite(edge.a, edge.b);
    std::map<std::uint32_t, std::vector<const Edge*>> outlines;
    for (const Edge& edge : open_) outlines[sets.find(edge.a)].push_back(&edge);
    for (const auto& [root, edges] : outlines) {
      check_.longest_outline = std::max(check_.longest_outline, edges.size());
      std::vector<std::uint32_t> vertices;
      for (const Edge* edge : edges)
        vertices.insert(vertices.end(), {first_source_[edge->a], first_source_[edge->b]});
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      add(check_.outlines, {}, std::move(vertices));
    }
  }

  /// Vertices of open edges that nearly meet another one, or the inside of an open edge.
  void look_at_cracks() {
    std::vector<std::uint32_t> vertices;
    for (const Edge& edge : open_) vertices.insert(vertices.end(), {edge.a, edge.b});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<glm::dvec3> points;
    for (const std::uint32_t w : vertices) points.push_back(at(w));
    const PointTree tree(points);
    const double tolerance = check_.tolerance_m;
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
      const std::vector<std::uint32_t> near = tree.near_segment(points[i], points[i], tolerance);
      const auto other =
          std::find_if(near.begin(), near.end(), [&](std::uint32_t n) { return n != i; });
      if (other != near.end())
        add(check_.unwelded_vertices, {},
            {first_source_[vertices[i]], first_source_[vertices[*other]]});
    }
    for (const Edge& edge : open_) {
      const glm::dvec3 a = at(edge.a), b = at(edge.b);
      for (const std::uint32_t n : tree.near_segment(a, b, tolerance)) {
        if (glm::distance(points[n], a) <= tolerance || glm::distance(points[n], b) <= tolerance)
          continue;
        add(check_.t_junctions, triangles_of(edge),
            {first_source_[vertices[n]], first_source_[edge.a], first_source_[edge.b]});
      }
    }
  }

  void look_at_intersections() {
    check_.self_intersections_sought = true;
    for (const auto& [s, t] : self_intersections(topology_)) {
      const std::uint32_t *a = &topology_.indices[3 * s], *b = &topology_.indices[3 * t];
      add(check_.self_intersections, {model_triangle(s), model_triangle(t)},
          {first_source_[a[0]], first_source_[a[1]], first_source_[a[2]], first_source_[b[0]],
           first_source_[b[1]], first_source_[b[2]]});
    }
  }

  const Model& model_;
  const MeshCheckOptions& options_;
  const Topology topology_;
  MeshCheck check_;
  /// The first used vertex of the model that was welded to each vertex of the topology.
  std::vector<std::uint32_t> first_source_;
  std::vector<Edge> open_;
};

}  // namespace

bool MeshCheck::casts_classical_volume() const {
  return open_edges.count == 0 && non_manifold_edges.count == 0 && misoriented_edges.count == 0 &&
         non_finite_vertices.count == 0 && edges > 0;
}

MeshCheck check_mesh(const Model& model, const MeshCheckOptions& options) {
  return Checker(model, options).run();
}

bool has_more_faults(const MeshCheck& check, const MeshCheck& than) {
  return check.open_edges.count > than.open_edges.count ||
         check.non_manifold_edges.count > than.non_manifold_edges.count ||
         check.misoriented_edges.count > than.misoriented_edges.count;
}

double mesh_tolerance(const Model& model, double tolerance_m) {
  return tolerance_of(box_of(model), tolerance_m);
}

std::string describe(const MeshCheck& check) {
  std::string words;
  const auto say = [&words](const MeshFinding& finding, const char* one, const char* many) {
    if (finding.count == 0) return;
    words += (words.empty() ? "" : ", ") + std::to_string(finding.count) +
             (finding.count == 1 ? one : many);
  };
  say(check.open_edges, " edge with one triangle only", " edges with one triangle only");
  say(check.non_manifold_edges, " edge with more than two triangles",
      " edges with more than two triangles");
  say(check.misoriented_edges, " edge whose two triangles face opposite ways",
      " edges whose two triangles face opposite ways");
  say(check.non_finite_vertices, " vertex that is not finite", " vertices that are not finite");
  if (words.empty() && check.edges == 0) words = "no triangle with an area";
  return words;
}

}  // namespace gnomon::pipeline
