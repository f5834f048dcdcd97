#include "pipeline/near_clip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace gnomon::pipeline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Gap that counts as a gap, as a part of the largest coordinate that takes part: a hundred times
/// the rounding of the float32 positions that are drawn.
constexpr double kClear = 1e-5;

struct Interval {
  double low = kInfinity, high = -kInfinity;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// The hull of region and light, in the caster's model space: an affine image of a hull is the hull
/// of the images, and planes stay planes.
struct Hull {
  std::vector<glm::dvec3> points;
  /// Not null: the hull also goes on for ever this way.
  glm::dvec3 towards_light{0.0};
  std::vector<glm::dvec3> normals;
};

std::optional<glm::dvec3> homogeneous_point(const glm::dvec4& p) {
  const glm::dvec3 point = glm::dvec3(p) / p.w;
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) {
    return std::nullopt;
  }
  return point;
}

Hull make_hull(const NearRegion& region, const glm::vec4& light_world,
               const glm::dmat4& model_from_world) {
  Hull hull;
  for (const glm::dvec3& corner : region.corners) {
    hull.points.push_back(glm::dvec3(model_from_world * glm::dvec4(corner, 1.0)));
  }
  const glm::dvec3 light = glm::dvec3(model_from_world * glm::dvec4(light_world));
  const bool directional = light_world.w == 0.0f;
  const std::vector<glm::dvec3> region_points = hull.points;
  const std::size_t count = region_points.size();
  // Faces that hold an edge of the region and the light, and the region's own faces.
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const glm::dvec3 edge = region_points[j] - region_points[i];
      hull.normals.push_back(glm::cross(edge, directional ? light : light - region_points[i]));
      for (std::size_t k = j + 1; k < count; ++k) {
        hull.normals.push_back(glm::cross(edge, region_points[k] - region_points[i]));
      }
    }
  }
  if (directional) {
    hull.towards_light = light;
  } else {
    hull.points.push_back(light);
  }
  return hull;
}

Interval extent(const Hull& hull, const glm::dvec3& normal) {
  Interval interval;
  for (const glm::dvec3& point : hull.points) interval.add(glm::dot(normal, point));
  const double rise = glm::dot(normal, hull.towards_light);
  const double rounding = 1e-12 * glm::length(normal) * glm::length(hull.towards_light);
  if (rise > rounding) interval.high = kInfinity;
  if (rise < -rounding) interval.low = -kInfinity;
  return interval;
}

bool apart(const Interval& hull, const Interval& caster, double clear) {
  return hull.low > caster.high + clear || caster.low > hull.high + clear;
}

}  // namespace

std::optional<NearRegion> near_region(const glm::mat4& clip_from_world) {
  const glm::dmat4 clip(clip_from_world);
  const double determinant = glm::determinant(clip);
  if (!std::isfinite(determinant) || determinant == 0.0) return std::nullopt;
  const glm::dmat4 world_from_clip = glm::inverse(clip);
  NearRegion region;
  // The eye is what the matrix sends to x = y = w = 0.
  const auto eye = homogeneous_point(world_from_clip * glm::dvec4(0.0, 0.0, -1.0, 0.0));
  if (!eye) return std::nullopt;
  region.corners.push_back(*eye);
  for (const double y : {-1.0, 1.0}) {
    for (const double x : {-1.0, 1.0}) {
      const auto corner = homogeneous_point(world_from_clip * glm::dvec4(x, y, -1.0, 1.0));
      if (!corner) return std::nullopt;
      region.corners.push_back(*corner);
    }
  }
  return region;
}

namespace {

/// Does a plane of the hull separate it from all points? `extent_of` gives the points' interval
/// along a direction of unit length; `largest` is the largest length among them.
template <class ExtentOf>
bool separated(const Hull& hull, double largest, ExtentOf extent_of) {
  for (const glm::dvec3& p : hull.points) largest = std::max(largest, glm::length(p));
  for (const glm::dvec3& normal : hull.normals) {
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) continue;
    const glm::dvec3 unit = normal / length;
    if (apart(extent(hull, unit), extent_of(unit), kClear * largest)) return true;
  }
  return false;
}

/// The same for the corners of the caster's bounds: what separates these separates the caster.
bool separated_from_bounds(const Hull& hull, const Topology& caster) {
  const glm::dvec3 middle = (caster.low + caster.high) * 0.5, half = caster.high - middle;
  const glm::dvec3 outermost = glm::max(glm::abs(caster.low), glm::abs(caster.high));
  return separated(hull, glm::length(outermost), [&](const glm::dvec3& unit) {
    const double at = glm::dot(unit, middle), reach = glm::dot(glm::abs(unit), half);
    return Interval{at - reach, at + reach};
  });
}

bool separated_from_corners(const Hull& hull, const Topology& caster) {
  double largest = 0.0;
  for (const glm::vec4& p : caster.positions) {
    largest = std::max(largest, glm::length(glm::dvec3(p)));
  }
  return separated(hull, largest, [&](const glm::dvec3& unit) {
    Interval interval;
    for (const glm::vec4& p : caster.positions) interval.add(glm::dot(unit, glm::dvec3(p)));
    return interval;
  });
}

}  // namespace

bool volume_may_touch(const NearRegion& region, const glm::vec4& light_world,
                      const Topology& caster, const glm::mat4& world_from_model) {
  const Hull hull = make_hull(region, light_world, glm::inverse(glm::dmat4(world_from_model)));
  return !separated_from_bounds(hull, caster) && !separated_from_corners(hull, caster);
}

VolumeMethod choose_method(VolumeMethod wanted, const std::optional<NearRegion>& region,
                           const glm::vec4& light_world, const Topology& caster,
                           const glm::mat4& world_from_model) {
  if (wanted != VolumeMethod::automatic) return wanted;
  if (!region || volume_may_touch(*region, light_world, caster, world_from_model)) {
    return VolumeMethod::zfail;
  }
  return VolumeMethod::zpass;
}

}  // namespace gnomon::pipeline
