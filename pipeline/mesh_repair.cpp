#include "pipeline/mesh_repair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/finite.h"
#include "pipeline/mesh_check.h"
#include "pipeline/repair_surface.h"
#include "pipeline/topology.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

using repair::Surface;
using repair::Triangle;

/// A corner of the model: its part and its vertex there.
struct ModelCorner {
  std::uint32_t part = 0, vertex = 0;
};

std::vector<ModelCorner> corners_of(const Model& model) {
  std::vector<ModelCorner> corners;
  for (std::uint32_t p = 0; p < model.parts.size(); ++p)
    for (const std::uint32_t v : model.parts[p].mesh.indices) corners.push_back({p, v});
  return corners;
}

Surface surface_of(const Model& model, const std::vector<ModelCorner>& corners,
                   MeshRepairReport& report) {
  const Topology topology = build_topology(model);
  Surface surface;
  for (const glm::vec4& p : topology.positions) surface.positions.emplace_back(p);
  for (std::uint32_t t = 0; t < topology.triangle_count(); ++t) {
    Triangle triangle;
    for (std::uint32_t k = 0; k < 3; ++k) {
      triangle.vertex[k] = topology.indices[3 * t + k];
      triangle.corner[k] = 3 * topology.model_triangles[t] + k;
    }
    surface.triangles.push_back(triangle);
  }
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    const auto finite = [&](const ModelCorner& corner) {
      return is_finite(glm::vec3(model.parts[corner.part].mesh.positions[corner.vertex]));
    };
    report.non_finite_triangles += !std::all_of(&corners[c], &corners[c] + 3, finite);
  }
  report.collapsed_triangles = topology.faults.dropped_triangles - report.non_finite_triangles;
  return surface;
}

/// Builds the parts anew: a vertex for each that differs in its fan, its attributes or its normal.
class Rebuilder {
 public:
  Rebuilder(const Model& model, const std::vector<ModelCorner>& corners, const Surface& surface)
      : model_(model), corners_(corners), surface_(surface) {
    out_.parts = model.parts;
    for (Part& part : out_.parts) part.mesh = {};
  }

  Model build() {
    for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) add(t);
    std::erase_if(out_.parts, [](const Part& part) { return part.mesh.indices.empty(); });
    return std::move(out_);
  }

 private:
  /// A fan's vertex, the model's vertex that it keeps the rest of, and the triangle whose normal it
  /// has (kNone: the model's; kNone - 1: the model's, reversed).
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;

  void add(std::uint32_t number) {
    const Triangle& t = surface_.triangles[number];
    const std::uint32_t p = corners_[t.corner[0]].part;
    const glm::dvec3 a = surface_.at(t.vertex[0]);
    const glm::dvec3 across =
        glm::cross(surface_.at(t.vertex[1]) - a, surface_.at(t.vertex[2]) - a);
    const double length = glm::length(across);
    const glm::vec3 plane(length > 0.0 ? across / length : glm::dvec3(0.0, 0.0, 1.0));
    const Mesh& from = model_.parts[p].mesh;
    Mesh& to = out_.parts[p].mesh;
    for (std::size_t k = 0; k < 3; ++k) {
      const ModelCorner& corner = corners_[t.corner[k]];
      // A hole's triangle may touch several parts; the rest of a vertex comes from its own.
      const bool own = corner.part == p;
      const std::uint32_t source = own ? corner.vertex : corners_[t.corner[0]].vertex;
      glm::vec3 normal = plane;
      std::uint32_t kind = number;
      if (!t.filling && own && !from.normals.empty()) {
        normal = from.normals[source];
        kind = repair::kNone;
        if (t.turned && glm::dot(normal, plane) < 0.0f) {
          normal = -normal;
          kind = repair::kNone - 1;
        }
      }
      const auto [it, fresh] = known_.try_emplace({p, {t.vertex[k], source, kind}},
                                                  static_cast<std::uint32_t>(to.positions.size()));
      to.indices.push_back(it->second);
      if (!fresh) continue;
      to.positions.emplace_back(surface_.positions[t.vertex[k]], 1.0f);
      if (!from.normals.empty()) to.normals.push_back(normal);
      if (!from.texcoords.empty()) to.texcoords.push_back(from.texcoords[source]);
      if (!from.colors.empty()) to.colors.push_back(from.colors[source]);
    }
  }

  const Model& model_;
  const std::vector<ModelCorner>& corners_;
  const Surface& surface_;
  Model out_;
  std::map<std::pair<std::uint32_t, Key>, std::uint32_t> known_;
};

/// The farthest that a corner of the model is from where it was.
double largest_move(const Model& model, const std::vector<ModelCorner>& corners,
                    const Surface& surface) {
  double largest = 0.0;
  for (const Triangle& t : surface.triangles) {
    if (t.filling) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      // A vertex that cuts an edge keeps what a neighbour has, and has not come from there.
      if (surface.home[t.corner[k]] != surface.place[t.vertex[k]]) continue;
      const ModelCorner& corner = corners[t.corner[k]];
      const glm::dvec3 was(model.parts[corner.part].mesh.positions[corner.vertex]);
      largest = std::max(largest, glm::distance(was, surface.at(t.vertex[k])));
    }
  }
  return largest;
}

}  // namespace

RepairedMesh repair_mesh(const Model& model, const MeshRepairOptions& options) {
  raster::require(options.max_hole_edges <= kMaxHoleEdges,
                  "max_hole_edges is at most kMaxHoleEdges");
  RepairedMesh out;
  MeshRepairReport& report = out.report;
  report.tolerance_m = mesh_tolerance(model, options.tolerance_m);
  const double parting = repair::kPartingShare * report.tolerance_m;
  const double radius = report.tolerance_m - parting;
  const std::vector<ModelCorner> corners = corners_of(model);
  Surface surface = surface_of(model, corners, report);
  repair::remove_repeated(surface, report);
  repair::weld_open_vertices(surface, radius, report);
  surface.home.assign(corners.size(), repair::kNone);
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) surface.home[t.corner[k]] = t.vertex[k];
  repair::cut_t_junctions(surface, radius, report);
  repair::remove_repeated(surface, report);
  repair::remove_flat(surface, report);
  repair::wind_patches(surface);
  repair::pair_half_edges(surface, report);
  repair::part_fans(surface);
  repair::close_holes(surface, options.max_hole_edges, report);
  repair::turn_outwards(surface, report);
  repair::cut_shared_edges(surface, report);
  repair::part_vertices(surface, parting, report);
  for (const Triangle& t : surface.triangles) report.turned_triangles += t.turned;
  report.largest_move_m = largest_move(model, corners, surface);
  out.model = Rebuilder(model, corners, surface).build();
  return out;
}

}  // namespace gnomon::pipeline
