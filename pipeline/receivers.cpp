// Proof that the reach is enough. Point light L: a point p of the infinite volume is L + t (c - L)
// with c on a casting triangle and t >= 1; it lies in the volume swept by the factor k when t <= k.
// For any function f with f(s x) = s f(x) for s > 0 that is positive on c - L,
//   t = f(p - L) / f(c - L) <= max f(p - L) / min f(c - L).
// Two such functions are used and the smaller bound is taken: the Euclidean norm (convex: its
// largest value over a polygon is at a corner; its smallest over a triangle is the point-triangle
// distance), and the distance along the axis from the light to the caster (linear: both at
// corners), which is tight for a flat receiver across the axis and holds only where the whole
// caster is in front of the light. In that case every p lies in the pyramid of slopes that the
// caster's corners span, and no nearer along the axis than the nearest corner, so receivers are
// clipped to it first; slopes and distance are widened by 1e-6 so that rounding (about 1e-15) cuts
// off nothing.
// Direction d (towards the light): p = c - t d with t >= 0, so t = s(p) - s(c) with s(x) = -d.x,
// and t <= max s(p) - min s(c), over receivers clipped to the caster's rectangle across d.
// The volume that is drawn has float32 corners: the margin of 1/256 is five decimal orders above
// that rounding.
#include "pipeline/receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/basis.h"
#include "pipeline/finite.h"
#include "pipeline/half_space.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

constexpr double kWiden = 1e-6;
/// A caster nearer to the light, along the axis or at all, than this part of its farthest corner
/// is "touched" by it.
constexpr double kTooNear = 1e-3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Region = std::vector<HalfSpace>;

/// Is the box wholly outside one of the half spaces?
bool box_outside(const Receivers::Group& group, const Region& region) {
  for (const HalfSpace& half : region) {
    const glm::dvec3 farthest(half.normal.x > 0.0 ? group.high.x : group.low.x,
                              half.normal.y > 0.0 ? group.high.y : group.low.y,
                              half.normal.z > 0.0 ? group.high.z : group.low.z);
    if (half.of(farthest) < 0.0) return true;
  }
  return false;
}

/// The largest values of two functions over receivers cut to a region: the distance from an origin
/// and the coordinate along an axis. Both are convex, so nothing has to be cut whose corners reach
/// no farther than what was found; the order of the receivers has no say in the result.
class Farthest {
 public:
  Farthest(const glm::dvec3& origin, const glm::dvec3& axis) : origin_(origin), axis_(axis) {}

  double distance = 0.0, along = -kInfinity;

  void look_at(const Receivers& receivers, const Region& region) {
    std::vector<std::pair<double, const Receivers::Group*>> order;
    for (const Receivers::Group& group : receivers.groups()) {
      if (!box_outside(group, region)) order.emplace_back(reach_of_box(group).first, &group);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [reach, group] : order) {
      const auto [square, most_along] = reach_of_box(*group);
      if (!matters(square, most_along)) continue;
      for (const WorldTriangle& triangle : group->triangles) look_at(triangle, region);
    }
  }

 private:
  /// Squared distance and coordinate that nothing in the box exceeds.
  std::pair<double, double> reach_of_box(const Receivers::Group& group) const {
    const glm::dvec3 low = group.low - origin_, high = group.high - origin_;
    const glm::dvec3 far = glm::max(glm::abs(low), glm::abs(high));
    const glm::dvec3 most = glm::max(axis_ * low, axis_ * high);
    return {glm::dot(far, far), most.x + most.y + most.z};
  }
  /// The margin is for rounding, of bounds and of cuts, a thousand times over.
  bool matters(double square, double most_along) const {
    return !(square * (1.0 + 1e-12) < distance * distance &&
             most_along + 1e-12 * std::sqrt(square) < along);
  }
  void look_at(const WorldTriangle& triangle, const Region& region) {
    double square = 0.0, most_along = -kInfinity;
    for (const glm::dvec3& corner : triangle) {
      const glm::dvec3 p = corner - origin_;
      square = std::max(square, glm::dot(p, p));
      most_along = std::max(most_along, glm::dot(axis_, p));
    }
    if (!matters(square, most_along)) return;
    polygon_.assign(triangle.begin(), triangle.end());
    clip(polygon_, region, scratch_);
    for (const glm::dvec3& p : polygon_) {
      distance = std::max(distance, glm::length(p - origin_));
      along = std::max(along, glm::dot(axis_, p - origin_));
    }
  }

  const glm::dvec3 origin_, axis_;
  Polygon polygon_, scratch_;
};

/// Distance from a point to a triangle (degenerate ones included): the nearest of the projection,
/// if it falls inside, and the three edges.
double distance_to(const glm::dvec3& point, const WorldTriangle& triangle) {
  double nearest = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 a = triangle[i], edge = triangle[(i + 1) % 3] - a;
    const double square = glm::dot(edge, edge);
    const double t = square > 0.0 ? std::clamp(glm::dot(point - a, edge) / square, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, glm::length(a + edge * t - point));
  }
  const glm::dvec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double area = glm::length(normal);
  if (area > 0.0) {
    bool inside = true;
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 edge = triangle[(i + 1) % 3] - triangle[i];
      inside = inside && glm::dot(glm::cross(edge, point - triangle[i]), normal) >= 0.0;
    }
    if (inside) {
      nearest = std::min(nearest, std::abs(glm::dot(point - triangle[0], normal)) / area);
    }
  }
  return nearest;
}

/// Distance from a point to the nearest of the triangles. None whose sphere about its first corner
/// is farther than what was found can be it.
double distance_to(const glm::dvec3& point, const CastingMesh& casting) {
  double nearest = kInfinity;
  for (std::size_t t = 0; t < casting.triangles.size(); ++t) {
    const WorldTriangle triangle = casting.triangle(t);
    const glm::dvec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
    const glm::dvec3 pa = triangle[0] - point;
    const double radius = std::sqrt(std::max(glm::dot(ab, ab), glm::dot(ac, ac)));
    const double reach = (nearest + radius) * (1.0 + 1e-12);
    if (glm::dot(pa, pa) > reach * reach) continue;
    nearest = std::min(nearest, distance_to(point, triangle));
  }
  return nearest;
}

struct Box {
  glm::dvec3 low{kInfinity}, high{-kInfinity};
  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

Reach reach_of(double amount, double least) {
  if (!(amount >= least)) return {Reach::Kind::none, 0.0};
  if (!std::isfinite(amount)) return {Reach::Kind::unbounded, 0.0};
  return {Reach::Kind::finite, amount};
}

/// The pyramid from the light (the origin of `basis`) round the caster.
struct Pyramid {
  Region region;
  bool usable = false;
  double nearest_z = 0.0;
};

Pyramid pyramid_round(const glm::dvec3& light, const CastingMesh& casting, const Basis& basis,
                      double farthest_corner) {
  Pyramid pyramid;
  double z_min = kInfinity;
  for (const glm::dvec3& corner : casting.corners) {
    z_min = std::min(z_min, glm::dot(basis.axis, corner - light));
  }
  if (!(z_min > kTooNear * farthest_corner)) return pyramid;
  glm::dvec2 low(kInfinity), high(-kInfinity);
  for (const glm::dvec3& corner : casting.corners) {
    const glm::dvec3 q = basis(corner - light);
    const glm::dvec2 slope = glm::dvec2(q) / q.z;
    low = glm::min(low, slope);
    high = glm::max(high, slope);
  }
  low -= kWiden;
  high += kWiden;
  const auto half = [&](const glm::dvec3& normal, double offset) {
    pyramid.region.push_back({normal, offset + glm::dot(normal, light)});
  };
  half(basis.axis, z_min * (1.0 - kWiden));
  half(basis.u - low.x * basis.axis, 0.0);
  half(high.x * basis.axis - basis.u, 0.0);
  half(basis.v - low.y * basis.axis, 0.0);
  half(high.y * basis.axis - basis.v, 0.0);
  pyramid.usable = true;
  pyramid.nearest_z = z_min;
  return pyramid;
}

Reach reach_from_point(const glm::dvec3& light, const CastingMesh& casting,
                       const Receivers& receivers) {
  Box box;
  double farthest_corner = 0.0;
  for (const glm::dvec3& corner : casting.corners) {
    box.add(corner);
    farthest_corner = std::max(farthest_corner, glm::length(corner - light));
  }
  const double nearest = distance_to(light, casting);
  if (!(nearest > kTooNear * farthest_corner)) return {Reach::Kind::unbounded, 0.0};

  const glm::dvec3 to_centre = (box.low + box.high) * 0.5 - light;
  const double centre_distance = glm::length(to_centre);
  Pyramid pyramid;
  Basis basis{};
  if (centre_distance > 0.0) {
    basis = basis_about(to_centre / centre_distance);
    pyramid = pyramid_round(light, casting, basis, farthest_corner);
  }
  Farthest farthest(light, basis.axis);
  farthest.look_at(receivers, pyramid.region);
  double factor = farthest.distance / nearest;
  if (pyramid.usable) {
    factor = std::min(factor, std::max(farthest.along, 0.0) / pyramid.nearest_z);
  }
  return reach_of(factor * (1.0 + kReachMargin), 1.0);
}

Reach reach_in_direction(const glm::dvec3& towards_light, const CastingMesh& casting,
                         const Receivers& receivers) {
  const Basis basis = basis_about(-towards_light);
  Box box;
  for (const glm::dvec3& corner : casting.corners) box.add(basis(corner));
  const double widen = kWiden * (1.0 + glm::length(box.high - box.low));
  const Region region{{basis.u, box.low.x - widen},
                      {-basis.u, -box.high.x - widen},
                      {basis.v, box.low.y - widen},
                      {-basis.v, -box.high.y - widen},
                      {basis.axis, box.low.z - widen}};
  Farthest farthest(glm::dvec3(0.0), basis.axis);
  farthest.look_at(receivers, region);
  if (farthest.along == -kInfinity) return {Reach::Kind::none, 0.0};
  return reach_of((farthest.along - box.low.z + widen) * (1.0 + kReachMargin), 0.0);
}

}  // namespace

Receivers::Receivers(const Scene& scene) {
  for (const Object& object : scene.objects) {
    raster::require(object.model != nullptr, "an object has a model");
    if (object.receives) add(*object.model, object.world_from_model);
  }
}

void Receivers::add(const Model& model, const glm::mat4& world_from_model) {
  const glm::dmat4 world(world_from_model);
  Group group;
  Box box;
  for (const Part& part : model.parts) {
    const Mesh& mesh = part.mesh;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      WorldTriangle triangle;
      bool finite = true;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        raster::require(mesh.indices[i + corner] < mesh.positions.size(),
                        "a mesh's index names one of its positions");
        triangle[corner] = glm::dvec3(world * glm::dvec4(mesh.positions[mesh.indices[i + corner]]));
        finite = finite && is_finite(triangle[corner]);
      }
      if (!finite) continue;
      for (const glm::dvec3& corner : triangle) box.add(corner);
      group.triangles.push_back(triangle);
    }
  }
  if (group.triangles.empty()) return;
  group.low = box.low;
  group.high = box.high;
  groups_.push_back(std::move(group));
}

void CastingMesh::assign(const Topology& topology, std::span<const std::int8_t> casting,
                         const glm::mat4& world_from_model) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  const glm::dmat4 world(world_from_model);
  corners.clear();
  triangles.clear();
  corner_of_.assign(topology.positions.size(), kUnused);
  for (std::size_t t = 0; t < casting.size(); ++t) {
    if (casting[t] == 0) continue;
    std::array<std::uint32_t, 3>& triangle = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = topology.indices[3 * t + k];
      if (corner_of_[vertex] == kUnused) {
        corner_of_[vertex] = static_cast<std::uint32_t>(corners.size());
        corners.emplace_back(world * glm::dvec4(topology.positions[vertex]));
      }
      triangle[k] = corner_of_[vertex];
    }
  }
}

Reach find_reach(const glm::vec4& light_world, const CastingMesh& casting,
                 const Receivers& receivers) {
  if (casting.triangles.empty()) return {Reach::Kind::none, 0.0};
  const glm::dvec3 light(light_world);
  if (light_world.w != 0.0f) return reach_from_point(light, casting, receivers);
  return reach_in_direction(glm::normalize(light), casting, receivers);
}

}  // namespace gnomon::pipeline
