#include "pipeline/patches.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/finite.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

using Corners = std::array<glm::vec3, 3>;

struct Surface {
  std::string name;
  std::vector<Corners> triangles;
};

glm::dvec3 area_normal(const Corners& t) {
  const glm::dvec3 a(t[0]), b(t[1]), c(t[2]);
  return glm::cross(b - a, c - a);
}

std::vector<Surface> surfaces_of(const Scene& scene) {
  std::vector<Surface> surfaces;
  for (const Object& object : scene.objects) {
    raster::require(object.model != nullptr, "an object has a model");
    const glm::dmat4 world(object.world_from_model);
    const std::vector<Part>& parts = object.model->parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      Surface surface{parts.size() == 1 ? object.name : object.name + " part " + std::to_string(p),
                      {}};
      const Mesh& mesh = parts[p].mesh;
      for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        Corners corners;
        for (std::size_t k = 0; k < 3; ++k)
          corners[k] = glm::vec3(world * glm::dvec4(mesh.positions[mesh.indices[i + k]]));
        const double twice_area = glm::length(area_normal(corners));
        if (twice_area > 0.0 && std::isfinite(twice_area)) surface.triangles.push_back(corners);
      }
      surfaces.push_back(std::move(surface));
    }
  }
  return surfaces;
}

double square_length(const glm::vec3& a, const glm::vec3& b) {
  const glm::dvec3 d = glm::dvec3(a) - glm::dvec3(b);
  return glm::dot(d, d);
}

/// Calls visit with the parts that a triangle is cut into once every edge longer than the root of
/// `square` is halved. Deep enough for a house in millimetres, and an end for any other.
template <class Visit>
void halve(const Corners& t, double square, int depth, const Visit& visit) {
  std::array<bool, 3> cut{};
  int cuts = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    cut[k] = depth > 0 && square_length(t[k], t[(k + 1) % 3]) > square;
    cuts += cut[k] ? 1 : 0;
  }
  if (cuts == 0) {
    visit(t);
    return;
  }
  const auto middle = [&](std::size_t k) { return (t[k] + t[(k + 1) % 3]) * 0.5f; };
  const auto go_on = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    halve({a, b, c}, square, depth - 1, visit);
  };
  if (cuts == 3) {
    const glm::vec3 m0 = middle(0), m1 = middle(1), m2 = middle(2);
    go_on(t[0], m0, m2);
    go_on(m0, t[1], m1);
    go_on(m2, m1, t[2]);
    go_on(m0, m1, m2);
    return;
  }
  // The corner k that the first cut edge begins at; for two, the second edge follows it.
  std::size_t k = 0;
  while (!(cut[k] && (cuts == 1 || cut[(k + 1) % 3]))) ++k;
  const glm::vec3 &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
  const glm::vec3 ab = (a + b) * 0.5f;
  if (cuts == 1) {
    go_on(a, ab, c);
    go_on(ab, b, c);
    return;
  }
  const glm::vec3 bc = (b + c) * 0.5f;
  go_on(ab, b, bc);
  if (square_length(a, bc) < square_length(ab, c)) {
    go_on(a, ab, bc);
    go_on(a, bc, c);
  } else {
    go_on(a, ab, c);
    go_on(ab, bc, c);
  }
}

constexpr int kMostHalvings = 24;

std::size_t count_parts(const std::vector<Surface>& surfaces, double edge_m, std::size_t stop) {
  std::size_t count = 0;
  for (const Surface& surface : surfaces) {
    for (const Corners& triangle : surface.triangles) {
      halve(triangle, edge_m * edge_m, kMostHalvings, [&](const Corners&) { ++count; });
      if (count > stop) return count;
    }
  }
  return count;
}

/// The least edge, to a thousandth, that gives no more than `count` patches.
double find_edge(const std::vector<Surface>& surfaces, std::size_t count) {
  double high = 0.0;
  for (const Surface& surface : surfaces) {
    for (const Corners& t : surface.triangles) {
      for (std::size_t k = 0; k < 3; ++k)
        high = std::max(high, std::sqrt(square_length(t[k], t[(k + 1) % 3])));
    }
  }
  double low = high;
  while (low > high * 1e-6 && count_parts(surfaces, low, count) <= count) low *= 0.5;
  high = std::min(high, low * 2.0);
  while (high > low * 1.001) {
    const double middle = std::sqrt(low * high);
    (count_parts(surfaces, middle, count) <= count ? high : low) = middle;
  }
  return high;
}

class Builder {
 public:
  explicit Builder(PatchModel& model) : model_(model) {}

  void add(const Corners& t, const glm::vec3& normal) {
    std::array<std::uint32_t, 3> vertices{};
    for (std::size_t k = 0; k < 3; ++k) vertices[k] = vertex(t[k], normal);
    const Patch patch =
        make_patch(model_, vertices, static_cast<std::uint32_t>(model_.surfaces.size() - 1));
    if (patch.area_m2 > 0.0) model_.patches.push_back(patch);
  }

 private:
  using Key =
      std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, long, long, long, std::size_t>;

  std::uint32_t vertex(const glm::vec3& position, const glm::vec3& normal) {
    // Normals of one plane's triangles differ by their rounding.
    const auto part = [](float x) { return std::lround(x * 1e4f); };
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };
    const Key key{bits(position.x), bits(position.y), bits(position.z),      part(normal.x),
                  part(normal.y),   part(normal.z),   model_.surfaces.size()};
    const auto [at, is_new] =
        known_.try_emplace(key, static_cast<std::uint32_t>(model_.vertices.size()));
    if (is_new) model_.vertices.push_back({position, normal});
    return at->second;
  }

  PatchModel& model_;
  std::map<Key, std::uint32_t> known_;
};

}  // namespace

Patch make_patch(const PatchModel& model, const std::array<std::uint32_t, 3>& vertices,
                 std::uint32_t surface) {
  Patch patch{.vertices = vertices, .surface = surface};
  const glm::dvec3 a = model.corner(patch, 0), b = model.corner(patch, 1),
                   c = model.corner(patch, 2);
  patch.center = (a + b + c) / 3.0;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double length = glm::length(normal);
  patch.area_m2 = 0.5 * length;
  if (length > 0.0) patch.normal = normal / length;
  return patch;
}

PatchModel make_patches(const Scene& scene, std::size_t count) {
  raster::require(count >= 1 && count <= 100'000, "a number of patches is between 1 and 100000");
  const std::vector<Surface> surfaces = surfaces_of(scene);
  const bool any = std::any_of(surfaces.begin(), surfaces.end(),
                               [](const Surface& s) { return !s.triangles.empty(); });
  raster::require(any, "a scene of patches has a triangle with an area");
  PatchModel model;
  model.longest_edge_m = find_edge(surfaces, count);
  const double square = model.longest_edge_m * model.longest_edge_m;
  Builder builder(model);
  for (const Surface& surface : surfaces) {
    model.surfaces.push_back(surface.name);
    for (const Corners& triangle : surface.triangles) {
      const glm::vec3 normal(glm::normalize(area_normal(triangle)));
      halve(triangle, square, kMostHalvings, [&](const Corners& t) { builder.add(t, normal); });
    }
  }
  return model;
}

}  // namespace gnomon::pipeline
