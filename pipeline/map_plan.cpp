// Frustum. Drawn is what lies before the eye and inside the sides of its view: depth clamp keeps
// what is nearer than the near plane. A shadow on a visible receiver comes from a caster that lies
// between it and the light, so both project to one place of the map: the rectangle that both the
// casters' corners and the receivers' visible corners span holds it. Near and far are the casters'
// own: a receiver beyond the far plane is compared as if it lay behind it, one before the near
// plane as if it lay on that. Casters get depths up to kMapDepthFar only, where clamping leaves one
// whose offset takes it farther: still before what a receiver beyond is compared with.
//
// Size. At a point whose pixel is p metres wide on a plane across the view, and at which one unit
// of the map's rectangle is s metres, the map needs extent * s / p texels for one a pixel. The
// largest such number is at a corner of a receiver's visible part, or nearly so: p grows with the
// distance from the eye and s with the distance from the light, both linearly.
//
// Offset. On a plane with slopes dx, dy a texel the stored depth at a texel's centre differs from
// the plane's at a point of that texel by at most (|dx| + |dy|) / 2 <= max(|dx|, |dy|) = m, which
// is what polygon offset multiplies its factor with: factor 1 is enough for the nearest texel. The
// 2x2 filter reads texels whose centres are up to one texel away in x and y: |dx| + |dy| <= 2 m,
// factor 2. A closed body's map holds the faces turned from the light: where it is thick, they are
// far behind any lit face. Of a plate h thick whose normal makes the angle t with the light, the
// averted face lies h / cos t behind the lit one, and the error over a texel w is at most w tan t:
// with h >= w no factor is needed at all, and light leaks less than with one. A body counts as
// thick when it is so by twice, in the mean (Topology::thickness). Units: one for each rounding to
// the buffer's format, and float32's 2^-23 of the coordinates, twice transformed, times the change
// of depth a metre.
#include "pipeline/map_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include "pipeline/displaced_caster.h"
#include "pipeline/finite.h"
#include "pipeline/half_space.h"
#include "pipeline/silhouette.h"
#include "raster/check.h"
#include "raster/clip.h"

namespace gnomon::pipeline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A map that is found has so many texels at least, and a multiple of them.
constexpr int kSizeStep = 64;
/// Nearest distance that a map tells apart where casters come up to the light, of the farthest.
constexpr double kNearest = 0x1p-6;

/// What lies before the eye and between the sides of its view.
std::array<HalfSpace, 5> view_of(const Camera& camera) {
  const glm::dmat4 rows = glm::transpose(glm::dmat4(camera.clip_from_world));
  std::array<HalfSpace, 5> halves;
  halves[0] = {glm::dvec3(rows[3]), raster::kMinW - rows[3].w};
  for (std::size_t i = 0; i < 4; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    const glm::dvec4 plane = rows[3] + sign * rows[static_cast<int>(i / 2)];
    halves[i + 1] = {glm::dvec3(plane), -plane.w};
  }
  return halves;
}

/// Calls body(a, b, c) with the world corners of each of a model's triangles whose corners are
/// finite; place(p) moves them in the model.
template <class Place, class Body>
void for_each_triangle(const Model& model, const glm::mat4& world_from_model, Place place,
                       Body body) {
  const glm::dmat4 world(world_from_model);
  for (const Part& part : model.parts) {
    const Mesh& mesh = part.mesh;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) {
        return glm::dvec3(world * glm::dvec4(place(mesh.positions[mesh.indices[i + k]])));
      };
      const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
      if (is_finite(a) && is_finite(b) && is_finite(c)) body(a, b, c);
    }
  }
}

/// Calls body(polygon) with each caster's triangles, or what of them lies in the region.
template <class Body>
void for_each_caster(const Scene& scene, const Casters& casters, const glm::vec4& light_world,
                     std::span<const HalfSpace> region, Body body) {
  Polygon polygon, scratch;
  for (const Object& object : scene.objects) {
    if (!casters.contains(object)) continue;
    const auto take = [&](const auto&... corners) {
      polygon.assign({corners...});
      if (!region.empty()) clip(polygon, region, scratch);
      if (!polygon.empty()) body(polygon);
    };
    if (!is_displaced(object)) {
      for_each_triangle(*object.caster(), object.world_from_model, std::identity(), take);
      continue;
    }
    const glm::dvec4 light = light_in_model(light_world, object.world_from_model);
    const auto move = [&](const glm::vec4& p) {
      return displaced(p, light, object.shadow_displace);
    };
    for_each_triangle(*object.caster(), object.world_from_model, move, take);
  }
}

/// The visible parts of everything that receives, in the region.
std::vector<Polygon> visible_receivers(const Scene& scene, const Camera& camera,
                                       std::span<const HalfSpace> region) {
  const std::array<HalfSpace, 5> view = view_of(camera);
  std::vector<Polygon> parts;
  Polygon scratch;
  for (const Object& object : scene.objects) {
    if (!object.receives) continue;
    for_each_triangle(*object.model, object.world_from_model, std::identity(),
                      [&](const auto&... corners) {
                        Polygon polygon{corners...};
                        clip(polygon, view, scratch);
                        clip(polygon, region, scratch);
                        if (!polygon.empty()) parts.push_back(std::move(polygon));
                      });
  }
  return parts;
}

/// Metres that a pixel is wide at a point, across the view.
class PixelSize {
 public:
  explicit PixelSize(const Camera& camera)
      : rows_(glm::transpose(glm::dmat4(camera.clip_from_world))),
        scale_(std::max(camera.width * 0.5 * glm::length(glm::dvec3(rows_[0])),
                        camera.height * 0.5 * glm::length(glm::dvec3(rows_[1])))) {}
  double at(const glm::dvec3& p) const { return glm::dot(rows_[3], glm::dvec4(p, 1.0)) / scale_; }

 private:
  glm::dmat4 rows_;
  double scale_;
};

int size_for(const LightView& view, const Rectangle& rectangle, std::vector<Polygon>& receivers,
             const Camera& camera, int largest) {
  const PixelSize pixel(camera);
  const double extent = std::max(rectangle.extent().x, rectangle.extent().y);
  double wanted = 1.0;
  const std::array<HalfSpace, 4> sides = view.sides(rectangle);
  Polygon scratch;
  for (Polygon& polygon : receivers) {
    clip(polygon, sides, scratch);
    for (const glm::dvec3& p : polygon) {
      const double pixel_m = pixel.at(p);
      if (!(pixel_m > 0.0)) return largest;
      wanted = std::max(wanted, extent * view.metres(view.local(p)) / pixel_m);
    }
  }
  // The margin takes four (MapPlanner::plan).
  wanted += 4.0;
  if (!(wanted < largest)) return largest;
  return std::min(largest, (static_cast<int>(wanted) / kSizeStep + 1) * kSizeStep);
}

/// What casters span in a light's view.
struct CasterSpan {
  Rectangle places;
  double near = kInfinity, far = -kInfinity;
  /// Within the view that one map serves.
  bool in_reach = true;
};

CasterSpan span_of_casters(const Scene& scene, const Casters& casters, const glm::vec4& light_world,
                           const LightView& view, std::span<const HalfSpace> region) {
  CasterSpan span;
  for_each_caster(scene, casters, light_world, region, [&](const Polygon& polygon) {
    for (const glm::dvec3& p : polygon) {
      const glm::dvec3 local = view.local(p);
      span.near = std::min(span.near, local.z);
      span.far = std::max(span.far, local.z);
      const bool ahead = !view.is_point() || local.z > 0.0;
      if (ahead) span.places.add(view.place(local));
      span.in_reach = span.in_reach &&
                      (!view.is_point() || glm::length(glm::dvec2(local)) < kWidestMap * local.z);
    }
  });
  return span;
}

/// Near and far plane about the casters. A caster may be flat and lie across the light: the range
/// is never less than a thousandth of the scene's size, so that rounding stays a small part of it.
glm::dvec2 planes_about(const CasterSpan& casters, const LightView& view, double size_m) {
  const double slack = 1e-3 * (casters.far - casters.near + size_m);
  const double far = casters.far + slack;
  if (!view.is_point()) return {casters.near - slack, far};
  return {std::max({casters.near - slack, 0.5 * casters.near, kNearest * far}), far};
}

void require_settings(const MapSettings& settings) {
  const auto is_size = [](int size) { return size >= 1 && size <= raster::kMaxTargetSize; };
  raster::require(!settings.size || is_size(*settings.size), "a map has 1 to 16384 texels a side");
  raster::require(is_size(settings.largest_size), "a map has 1 to 16384 texels a side");
  raster::require(!settings.fov_tangent ||
                      (*settings.fov_tangent > 0.0f && std::isfinite(*settings.fov_tangent)),
                  "the tangent of a map's angle of view is positive");
  raster::require(!settings.near_far_m || (settings.near_far_m->x < settings.near_far_m->y &&
                                           std::isfinite(settings.near_far_m->x) &&
                                           std::isfinite(settings.near_far_m->y)),
                  "a map's near plane lies before the far one");
}

}  // namespace

MapPlanner::MapPlanner(const Scene& scene, const Casters& casters, const Light& light,
                       const Camera& camera, const MapSettings& settings)
    : scene_(scene),
      casters_(casters),
      light_(light),
      camera_(camera),
      settings_(settings),
      low_(kInfinity),
      high_(-kInfinity) {
  require_settings(settings);
  for_each_caster(scene, casters, light.position, {}, [&](const Polygon& polygon) {
    for (const glm::dvec3& p : polygon) {
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
  });
}

std::optional<MapPlan> MapPlanner::plan(const LightView& view,
                                        const std::optional<Rectangle>& part) const {
  std::array<HalfSpace, 4> sides;
  std::span<const HalfSpace> region;
  if (part) region = sides = view.sides(*part);
  const CasterSpan span = span_of_casters(scene_, casters_, light_.position, view, region);
  if (!part && !span.in_reach) return {};
  std::vector<Polygon> receivers = visible_receivers(scene_, camera_, region);
  Rectangle of_receivers;
  for (const Polygon& polygon : receivers) {
    for (const glm::dvec3& p : polygon) {
      const glm::dvec3 local = view.local(p);
      if (!view.is_point() || local.z > 0.0)
        of_receivers.add(view.place(local));
      else if (!part)
        return {};
    }
  }
  Rectangle rectangle{glm::max(span.places.low, of_receivers.low),
                      glm::min(span.places.high, of_receivers.high)};
  const bool by_hand = settings_.fov_tangent && view.is_point() && settings_.sides != MapSides::six;
  if (by_hand) {
    const glm::dvec2 side(static_cast<double>(*settings_.fov_tangent));
    rectangle = {-side, side};
  } else if (part) {
    // Cutting rounds, and next to the light a place is any number.
    rectangle = {glm::max(rectangle.low, part->low), glm::min(rectangle.high, part->high)};
  }
  if (!(span.near <= span.far) || rectangle.empty()) return MapPlan{.empty = true};

  MapPlan plan;
  plan.light = light_.position;
  plan.size = settings_.size
                  ? *settings_.size
                  : size_for(view, rectangle, receivers, camera_, settings_.largest_size);
  const glm::dvec2 extent = rectangle.extent();
  plan.texel_m = std::max(extent.x, extent.y) / plan.size * (view.is_point() ? span.far : 1.0);
  if (!by_hand) {
    // So that a lookup at the edge finds texels on both sides.
    const glm::dvec2 margin = rectangle.extent() * (2.0 / plan.size);
    rectangle = {rectangle.low - margin, rectangle.high + margin};
  }
  const double of_light = view.is_point() ? glm::length(glm::dvec3(light_.position)) : 0.0;
  const double size_m = glm::length(glm::max(glm::abs(low_), glm::abs(high_))) + of_light;
  glm::dvec2 planes = planes_about(span, view, size_m);
  if (settings_.near_far_m) {
    planes = glm::dvec2(*settings_.near_far_m);
    raster::require(!view.is_point() || planes.x > 0.0,
                    "a point light's near plane lies before it");
  }
  plan.clip_from_world = view.clip_from_world(rectangle, planes.x, planes.y);
  const double one = settings_.format == raster::DepthFormat::d24 ? 0xffffff : 0xffff;
  const double rounding = 0x1p-21 * size_m * view.depth_rate(planes.x, planes.y) * one;
  const auto units = static_cast<float>(2.0 + rounding);
  const float factor = settings_.filter == raster::Filter::nearest ? 1.0f : 2.0f;
  plan.offset = settings_.offset.value_or(raster::PolygonOffset{factor, units});
  plan.offset_of_thick = settings_.offset.value_or(raster::PolygonOffset{0.0f, units});
  return plan;
}

}  // namespace gnomon::pipeline
