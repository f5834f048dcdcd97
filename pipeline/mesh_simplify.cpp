#include "pipeline/mesh_simplify.h"

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <meshoptimizer.h>
#include <glm/geometric.hpp>

#include "pipeline/mesh_check.h"
#include "pipeline/mesh_repair.h"
#include "pipeline/surface_distance.h"
#include "pipeline/topology.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

constexpr int kTries = 12;
constexpr double kBackOff = 0.7;
/// A normal farther than 60 degrees from its triangle's belongs to the other side of a crease.
constexpr float kCreaseCosine = 0.5f;

/// A part's triangles over vertices with different positions, and the part's vertices at each.
struct WeldedPart {
  Topology topology;
  std::vector<float> positions;
  std::vector<std::vector<std::uint32_t>> sources;
};

WeldedPart weld_part(const Part& part) {
  Model alone;
  alone.parts.push_back({.mesh = {.positions = part.mesh.positions, .indices = part.mesh.indices}});
  WeldedPart welded{.topology = build_topology(alone)};
  for (const glm::vec4& p : welded.topology.positions)
    welded.positions.insert(welded.positions.end(), {p.x, p.y, p.z});
  welded.sources.resize(welded.topology.positions.size());
  for (std::uint32_t v = 0; v < part.mesh.positions.size(); ++v)
    welded.sources[welded.topology.welded[v]].push_back(v);
  return welded;
}

std::vector<std::uint32_t> collapse_edges(const WeldedPart& part, double error_m) {
  const std::vector<std::uint32_t>& indices = part.topology.indices;
  const std::size_t vertices = part.topology.positions.size();
  constexpr std::size_t kStride = 3 * sizeof(float);
  const float scale = meshopt_simplifyScale(part.positions.data(), vertices, kStride);
  if (!(scale > 0.0f)) return indices;
  std::vector<std::uint32_t> out(indices.size());
  out.resize(meshopt_simplify(out.data(), indices.data(), indices.size(), part.positions.data(),
                              vertices, kStride, 0, static_cast<float>(error_m / scale),
                              meshopt_SimplifyLockBorder, nullptr));
  return out;
}

/// The part with other triangles over its welded vertices.
Part with_triangles(const Part& part, const WeldedPart& welded,
                    const std::vector<std::uint32_t>& indices) {
  Part out{.material = part.material, .two_sided = part.two_sided};
  const Mesh& from = part.mesh;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const auto at = [&](std::size_t k) {
      return glm::dvec3(welded.topology.positions[indices[i + k]]);
    };
    const glm::dvec3 across = glm::cross(at(1) - at(0), at(2) - at(0));
    const double length = glm::length(across);
    const glm::vec3 plane(length > 0.0 ? across / length : glm::dvec3(0.0, 0.0, 1.0));
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<std::uint32_t>& sources = welded.sources[indices[i + k]];
      std::uint32_t best = sources[0];
      glm::vec3 normal = plane;
      float fit = kCreaseCosine;
      if (!from.normals.empty())
        for (const std::uint32_t v : sources)
          if (const float cosine = glm::dot(from.normals[v], plane); cosine > fit) {
            fit = cosine;
            best = v;
            normal = from.normals[v];
          }
      out.mesh.indices.push_back(static_cast<std::uint32_t>(out.mesh.positions.size()));
      out.mesh.positions.push_back(welded.topology.positions[indices[i + k]]);
      out.mesh.normals.push_back(normal);
      if (!from.colors.empty()) out.mesh.colors.push_back(from.colors[best]);
    }
  }
  return out;
}

std::size_t triangles_of(const Model& model) {
  std::size_t count = 0;
  for (const Part& part : model.parts) count += part.mesh.triangle_count();
  return count;
}

}  // namespace

double metres_of_pixels(double error_px, double distance_m, double fov_y_rad, double rows) {
  return error_px * 2.0 * distance_m * std::tan(fov_y_rad / 2.0) / rows;
}

SimplifiedMesh simplify_mesh(const Model& model, double error_m) {
  raster::require(std::isfinite(error_m) && error_m > 0.0, "error_m is positive and finite");
  const MeshCheckOptions options{.places = 0, .self_intersections = false};
  const MeshCheck before = check_mesh(model, options);
  std::vector<WeldedPart> welded;
  for (const Part& part : model.parts) welded.push_back(weld_part(part));
  SimplifiedMesh out;
  MeshSimplifyReport& report = out.report;
  report.error_m = error_m;
  report.triangles_before = report.triangles_after = triangles_of(model);
  double given_m = error_m;
  for (int attempt = 0; attempt < kTries; ++attempt, given_m *= kBackOff) {
    Model simple;
    for (std::size_t p = 0; p < model.parts.size(); ++p) {
      Part part = with_triangles(model.parts[p], welded[p], collapse_edges(welded[p], given_m));
      if (!part.mesh.indices.empty()) simple.parts.push_back(std::move(part));
    }
    report.parted_edges = 0;
    if (has_more_faults(check_mesh(simple, options), before)) {
      // A model that was fit for volumes is made so again, if that is all it takes.
      RepairedMesh repaired = repair_mesh(simple, {.max_hole_edges = 0});
      if (has_more_faults(check_mesh(repaired.model, options), before)) {
        ++report.faulty_tries;
        continue;
      }
      report.parted_edges = repaired.report.parted_edges;
      simple = std::move(repaired.model);
    }
    const double measured_m = surface_distance(model, simple);
    if (measured_m > error_m || simple.parts.empty()) {
      ++report.distant_tries;
      continue;
    }
    report.given_error_m = given_m;
    report.measured_error_m = measured_m;
    report.triangles_after = triangles_of(simple);
    out.model = std::move(simple);
    return out;
  }
  report.given_up = true;
  report.parted_edges = 0;
  out.model = model;
  return out;
}

}  // namespace gnomon::pipeline
