#include "pipeline/topology.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/finite.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

using PositionKey = std::array<std::uint32_t, 3>;

PositionKey position_key(const glm::vec4& p) {
  // Adding +0 turns -0 into +0 and leaves every other value as it is.
  return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
          std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

struct Soup {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;
};

Soup merge_parts(const Model& model) {
  std::size_t position_count = 0, index_count = 0;
  for (const Part& part : model.parts) {
    position_count += part.mesh.positions.size();
    index_count += part.mesh.indices.size();
  }
  // Edge uses, one an index, are numbered with 32 bits too.
  raster::require(position_count <= std::numeric_limits<std::uint32_t>::max() &&
                      index_count <= std::numeric_limits<std::uint32_t>::max(),
                  "a model has fewer than 2^32 vertices and indices");
  Soup soup;
  soup.positions.reserve(position_count);
  soup.indices.reserve(index_count);
  for (const Part& part : model.parts) {
    const Mesh& mesh = part.mesh;
    raster::require(mesh.indices.size() % 3 == 0, "a mesh has three indices a triangle");
    const auto base = static_cast<std::uint32_t>(soup.positions.size());
    soup.positions.insert(soup.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const std::uint32_t index : mesh.indices) {
      raster::require(index < mesh.positions.size(), "a mesh's index names one of its positions");
      soup.indices.push_back(base + index);
    }
  }
  return soup;
}

/// For each position the index of its welded vertex; `welded` receives those in order of first
/// appearance.
std::vector<std::uint32_t> weld(const std::vector<glm::vec4>& positions,
                                std::vector<glm::vec4>& welded) {
  std::vector<std::pair<PositionKey, std::uint32_t>> order(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) order[i] = {position_key(positions[i]), i};
  std::sort(order.begin(), order.end());

  std::vector<std::uint32_t> first(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool repeated = i > 0 && order[i].first == order[i - 1].first;
    first[order[i].second] = repeated ? first[order[i - 1].second] : order[i].second;
  }
  std::vector<std::uint32_t> vertex(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (first[i] == i) {
      vertex[i] = static_cast<std::uint32_t>(welded.size());
      welded.push_back(positions[i]);
    } else {
      vertex[i] = vertex[first[i]];
    }
  }
  return vertex;
}

struct HalfEdge {
  std::uint32_t a, b, triangle;
  int sign;
  auto operator<=>(const HalfEdge&) const = default;
};

void build_edges(Topology& topology) {
  std::vector<HalfEdge> halves;
  halves.reserve(topology.indices.size());
  for (std::uint32_t t = 0; t < topology.triangle_count(); ++t) {
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t from = topology.indices[3 * t + corner];
      const std::uint32_t to = topology.indices[3 * t + (corner + 1) % 3];
      halves.push_back({std::min(from, to), std::max(from, to), t, from < to ? 1 : -1});
    }
  }
  std::sort(halves.begin(), halves.end());
  topology.uses.reserve(halves.size());
  for (const HalfEdge& half : halves) {
    if (topology.edges.empty() || topology.edges.back().a != half.a ||
        topology.edges.back().b != half.b) {
      topology.edges.push_back({half.a, half.b, static_cast<std::uint32_t>(topology.uses.size())});
    }
    topology.uses.push_back({half.triangle, half.sign});
    ++topology.edges.back().use_count;
  }
}

double thickness_of(const Topology& topology) {
  if (!topology.closed() || topology.triangle_count() == 0) return 0.0;
  const TrianglePlanes& planes = topology.planes;
  double area = 0.0, volume = 0.0;
  for (std::size_t t = 0; t < topology.triangle_count(); ++t) {
    const glm::dvec3 normal(planes.normal_x[t], planes.normal_y[t], planes.normal_z[t]);
    const glm::dvec3 corner(planes.corner_x[t], planes.corner_y[t], planes.corner_z[t]);
    area += 0.5 * glm::length(normal);
    volume += glm::dot(normal, corner - topology.low) / 6.0;
  }
  return area > 0.0 ? 2.0 * volume / area : 0.0;
}

void count_faults(Topology& topology) {
  TopologyFaults& faults = topology.faults;
  for (const Edge& edge : topology.edges) {
    long long sum = 0;
    for (const EdgeUse& use : topology.uses_of(edge)) sum += use.sign;
    if (edge.use_count == 1) ++faults.boundary_edges;
    if (edge.use_count > 2) ++faults.non_manifold_edges;
    if (edge.use_count == 2 && sum != 0) ++faults.inconsistent_edges;
    if (sum != 0) ++faults.unbalanced_edges;
  }
}

void build_pairs(Topology& topology) {
  topology.pairs.reserve(topology.edges.size());
  for (std::uint32_t e = 0; e < topology.edges.size(); ++e) {
    const std::span<const EdgeUse> uses = topology.uses_of(topology.edges[e]);
    EdgePair pair;
    if (uses.size() == 2 && uses[0].sign != uses[1].sign) {
      const bool first_forward = uses[0].sign > 0;
      pair = {uses[first_forward ? 0 : 1].triangle, uses[first_forward ? 1 : 0].triangle};
    } else {
      topology.unpaired_edges.push_back(e);
    }
    topology.pairs.push_back(pair);
  }
}

void build_planes(Topology& topology) {
  TrianglePlanes& planes = topology.planes;
  const std::size_t count = topology.triangle_count();
  for (auto* component : {&planes.normal_x, &planes.normal_y, &planes.normal_z}) {
    component->clear();
    component->reserve(count);
  }
  for (auto* component : {&planes.corner_x, &planes.corner_y, &planes.corner_z}) {
    component->clear();
    component->reserve(count);
  }
  for (std::size_t t = 0; t < count; ++t) {
    const glm::vec4& corner = topology.positions[topology.indices[3 * t]];
    const glm::dvec3 a(corner), b(topology.positions[topology.indices[3 * t + 1]]),
        c(topology.positions[topology.indices[3 * t + 2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    planes.normal_x.push_back(normal.x);
    planes.normal_y.push_back(normal.y);
    planes.normal_z.push_back(normal.z);
    planes.corner_x.push_back(corner.x);
    planes.corner_y.push_back(corner.y);
    planes.corner_z.push_back(corner.z);
    if (t == 0) topology.low = topology.high = a;
    topology.low = glm::min(topology.low, glm::min(a, glm::min(b, c)));
    topology.high = glm::max(topology.high, glm::max(a, glm::max(b, c)));
  }
}

}  // namespace

Topology build_topology(const Model& model) {
  const Soup soup = merge_parts(model);
  Topology topology;
  topology.welded = weld(soup.positions, topology.positions);
  const std::vector<std::uint32_t>& vertex = topology.welded;
  for (std::size_t i = 0; i + 2 < soup.indices.size(); i += 3) {
    const std::uint32_t a = vertex[soup.indices[i]], b = vertex[soup.indices[i + 1]],
                        c = vertex[soup.indices[i + 2]];
    const bool usable = a != b && b != c && c != a && is_finite(glm::vec3(topology.positions[a])) &&
                        is_finite(glm::vec3(topology.positions[b])) &&
                        is_finite(glm::vec3(topology.positions[c]));
    if (!usable) {
      ++topology.faults.dropped_triangles;
      continue;
    }
    topology.indices.insert(topology.indices.end(), {a, b, c});
    topology.model_triangles.push_back(static_cast<std::uint32_t>(i / 3));
  }
  build_edges(topology);
  count_faults(topology);
  build_pairs(topology);
  build_planes(topology);
  topology.thickness = thickness_of(topology);
  return topology;
}

void update_planes(Topology& topology) { build_planes(topology); }

std::string describe(const TopologyFaults& faults) {
  std::string words;
  const auto say = [&words](std::size_t count, const char* what) {
    if (count == 0) return;
    words += (words.empty() ? "" : ", ") + std::to_string(count) + what;
  };
  say(faults.boundary_edges, " edges with one triangle only (a hole or an open sheet)");
  say(faults.non_manifold_edges, " edges with more than two triangles");
  say(faults.inconsistent_edges, " edges whose two triangles face opposite ways");
  say(faults.dropped_triangles, " triangles without area or with a coordinate that is no number");
  return words;
}

std::shared_ptr<const Topology> TopologyCache::of(const std::shared_ptr<const Model>& model) {
  raster::require(model != nullptr, "an object has a model");
  for (const Entry& entry : entries_) {
    if (entry.model == model) return entry.topology;
  }
  entries_.push_back({model, std::make_shared<const Topology>(build_topology(*model))});
  return entries_.back().topology;
}

}  // namespace gnomon::pipeline
