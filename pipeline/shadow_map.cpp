// Frustum. Drawn is what lies before the eye and inside the sides of its view: depth clamp keeps
// what is nearer than the near plane. A shadow on a visible receiver comes from a caster that lies
// between it and the light, so both project to one place of the map: the rectangle that both the
// casters' corners and the receivers' visible corners span holds it. Near and far are the casters'
// own: a receiver beyond the far plane is compared as if it lay behind it, one before the near
// plane as if it lay on that. Casters get depths up to kDepthFar only, where clamping leaves one
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
// factor 2. Units: one for each rounding to the buffer's format, and float32's 2^-23 of the
// coordinates, twice transformed, times the change of depth a metre.
#include "pipeline/shadow_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/basis.h"
#include "pipeline/finite.h"
#include "pipeline/half_space.h"
#include "pipeline/silhouette.h"
#include "raster/check.h"
#include "raster/clip.h"

namespace gnomon::pipeline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Tangent of half the angle of view that one map serves, 80 degrees.
constexpr double kWidest = 5.67128181961771;
/// The casters' part of the map's depths. A power of two less than 1, so that float32 has it.
constexpr double kDepthFar = 1.0 - 1.0 / 1024.0;
/// A map that is found has so many texels at least, and a multiple of them.
constexpr int kSizeStep = 64;

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

/// Calls body(a, b, c) with the world corners of each triangle of an object whose corners are
/// finite.
template <class Body>
void for_each_triangle(const Object& object, Body body) {
  const glm::dmat4 world(object.world_from_model);
  for (const Part& part : object.model->parts) {
    const Mesh& mesh = part.mesh;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      const auto corner = [&](std::size_t k) {
        return glm::dvec3(world * glm::dvec4(mesh.positions[mesh.indices[i + k]]));
      };
      const glm::dvec3 a = corner(0), b = corner(1), c = corner(2);
      if (is_finite(a) && is_finite(b) && is_finite(c)) body(a, b, c);
    }
  }
}

struct Rectangle {
  glm::dvec2 low{kInfinity}, high{-kInfinity};
  void add(const glm::dvec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  bool empty() const { return !(low.x < high.x && low.y < high.y); }
  glm::dvec2 extent() const { return high - low; }
};

/// The light's view of space: places on its map as slopes (a point light) or metres (a direction),
/// and the distance along its axis.
class LightView {
 public:
  LightView(const Light& light, const glm::dvec3& aim) : is_point_(light.position.w != 0.0f) {
    const glm::dvec3 at(light.position);
    const glm::dvec3 axis = is_point_ ? aim - at : -at;
    basis_ = basis_about(glm::normalize(axis));
    origin_ = is_point_ ? at : aim;
  }

  bool is_point() const { return is_point_; }
  glm::dvec3 local(const glm::dvec3& p) const { return basis_(p - origin_); }
  glm::dvec2 place(const glm::dvec3& local) const {
    return is_point_ ? glm::dvec2(local) / local.z : glm::dvec2(local);
  }
  /// Metres that one unit of place is at a point.
  double metres(const glm::dvec3& local) const { return is_point_ ? local.z : 1.0; }

  /// The points whose place is not below `bound` along a coordinate (not above it, for sign -1).
  HalfSpace beside(const glm::dvec3& along, double bound, double sign) const {
    const glm::dvec3 normal = is_point_ ? along - bound * basis_.axis : along;
    const double offset = is_point_ ? 0.0 : bound;
    return {sign * normal, sign * (offset + glm::dot(normal, origin_))};
  }
  std::array<HalfSpace, 4> sides(const Rectangle& r) const {
    return {beside(basis_.u, r.low.x, 1.0), beside(basis_.u, r.high.x, -1.0),
            beside(basis_.v, r.low.y, 1.0), beside(basis_.v, r.high.y, -1.0)};
  }

  glm::mat4 clip_from_world(const Rectangle& r, double near, double far) const {
    const glm::dvec2 scale = 2.0 / r.extent(), shift = -(r.low + r.high) / r.extent();
    const double depth = 1.0 / (far - near);
    // Rows over (u, v, axis, 1).
    glm::dmat4 rows(0.0);
    rows[0] =
        is_point_ ? glm::dvec4(scale.x, 0.0, shift.x, 0.0) : glm::dvec4(scale.x, 0.0, 0.0, shift.x);
    rows[1] =
        is_point_ ? glm::dvec4(0.0, scale.y, shift.y, 0.0) : glm::dvec4(0.0, scale.y, 0.0, shift.y);
    rows[2] = is_point_ ? glm::dvec4(0.0, 0.0, (far + near) * depth, -2.0 * far * near * depth)
                        : glm::dvec4(0.0, 0.0, 2.0 * depth, -(far + near) * depth);
    rows[3] = is_point_ ? glm::dvec4(0.0, 0.0, 1.0, 0.0) : glm::dvec4(0.0, 0.0, 0.0, 1.0);
    glm::dmat4 local_rows(0.0);
    const std::array<glm::dvec3, 3> axes{basis_.u, basis_.v, basis_.axis};
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3& axis = axes[static_cast<std::size_t>(i)];
      local_rows[i] = glm::dvec4(axis, -glm::dot(axis, origin_));
    }
    local_rows[3] = glm::dvec4(0.0, 0.0, 0.0, 1.0);
    return glm::mat4(glm::transpose(rows) * glm::transpose(local_rows));
  }

  /// The greatest change of depth (of [0, 1]) a metre.
  double depth_rate(double near, double far) const {
    return is_point_ ? far / ((far - near) * near) : 1.0 / (far - near);
  }

 private:
  bool is_point_;
  Basis basis_{};
  glm::dvec3 origin_{0.0};
};

struct CasterBounds {
  glm::dvec3 low{kInfinity}, high{-kInfinity};
  glm::dvec3 middle() const { return (low + high) * 0.5; }
};

CasterBounds bounds_of_casters(const Scene& scene) {
  CasterBounds bounds;
  for (const Object& object : scene.objects) {
    if (!object.casts) continue;
    for_each_triangle(object, [&](const auto&... corners) {
      for (const glm::dvec3& p : {corners...}) {
        bounds.low = glm::min(bounds.low, p);
        bounds.high = glm::max(bounds.high, p);
      }
    });
  }
  return bounds;
}

/// The visible parts of everything that receives.
std::vector<Polygon> visible_receivers(const Scene& scene, const Camera& camera) {
  const std::array<HalfSpace, 5> view = view_of(camera);
  std::vector<Polygon> parts;
  Polygon scratch;
  for (const Object& object : scene.objects) {
    if (!object.receives) continue;
    for_each_triangle(object, [&](const auto&... corners) {
      Polygon polygon{corners...};
      clip(polygon, view, scratch);
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
  // The margin takes four (plan_shadow_map).
  wanted += 4.0;
  if (!(wanted < largest)) return largest;
  return std::min(largest, (static_cast<int>(wanted) / kSizeStep + 1) * kSizeStep);
}

double largest_coordinate(const CasterBounds& bounds, const Light& light) {
  const glm::dvec3 far = glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
  const double of_light = light.position.w != 0.0f ? glm::length(glm::dvec3(light.position)) : 0.0;
  return glm::length(far) + of_light;
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

std::optional<MapPlan> plan_shadow_map(const Scene& scene, const Light& light, const Camera& camera,
                                       const MapSettings& settings) {
  require_settings(settings);
  // The same rules as for volumes.
  (void)light_in_model(light.position, glm::mat4(1.0f));
  const CasterBounds casters = bounds_of_casters(scene);
  if (casters.low.x > casters.high.x) return MapPlan{.empty = true};
  if (light.position.w != 0.0f && casters.middle() == glm::dvec3(light.position)) return {};
  const LightView view(light, casters.middle());

  Rectangle of_casters, of_receivers;
  double near = kInfinity, far = -kInfinity;
  bool in_reach = true;
  for (const Object& object : scene.objects) {
    if (!object.casts) continue;
    for_each_triangle(object, [&](const auto&... corners) {
      for (const glm::dvec3& p : {corners...}) {
        const glm::dvec3 local = view.local(p);
        near = std::min(near, local.z);
        far = std::max(far, local.z);
        in_reach =
            in_reach && (!view.is_point() || glm::length(glm::dvec2(local)) < kWidest * local.z);
        of_casters.add(view.place(local));
      }
    });
  }
  if (!in_reach) return {};
  std::vector<Polygon> receivers = visible_receivers(scene, camera);
  for (const Polygon& polygon : receivers) {
    for (const glm::dvec3& p : polygon) {
      const glm::dvec3 local = view.local(p);
      if (view.is_point() && !(local.z > 0.0)) return {};
      of_receivers.add(view.place(local));
    }
  }
  Rectangle rectangle{glm::max(of_casters.low, of_receivers.low),
                      glm::min(of_casters.high, of_receivers.high)};
  if (settings.fov_tangent && view.is_point()) {
    const glm::dvec2 side(static_cast<double>(*settings.fov_tangent));
    rectangle = {-side, side};
  }
  if (rectangle.empty()) return MapPlan{.empty = true};

  MapPlan plan;
  plan.size = settings.size ? *settings.size
                            : size_for(view, rectangle, receivers, camera, settings.largest_size);
  if (!settings.fov_tangent) {
    // So that a lookup at the edge finds texels on both sides.
    const glm::dvec2 margin = rectangle.extent() * (2.0 / plan.size);
    rectangle = {rectangle.low - margin, rectangle.high + margin};
  }
  // A caster may be flat and lie across the light: the range is never less than a thousandth of the
  // scene's size, so that rounding stays a small part of it.
  const double size_m = largest_coordinate(casters, light);
  const double slack = 1e-3 * (far - near + size_m);
  near = view.is_point() ? std::max(near - slack, 0.5 * near) : near - slack;
  far += slack;
  if (settings.near_far_m) {
    near = static_cast<double>(settings.near_far_m->x);
    far = static_cast<double>(settings.near_far_m->y);
    raster::require(!view.is_point() || near > 0.0, "a point light's near plane lies before it");
  }
  plan.clip_from_world = view.clip_from_world(rectangle, near, far);
  const double one = settings.format == raster::DepthFormat::d24 ? 0xffffff : 0xffff;
  const double rounding = 0x1p-21 * size_m;
  plan.offset = settings.offset.value_or(
      raster::PolygonOffset{settings.filter == raster::Filter::nearest ? 1.0f : 2.0f,
                            static_cast<float>(2.0 + rounding * view.depth_rate(near, far) * one)});
  return plan;
}

raster::DepthBuffer& MapMemory::map(std::size_t number, int size, raster::DepthFormat format) {
  if (maps_.size() <= number) maps_.resize(number + 1);
  std::unique_ptr<raster::DepthBuffer>& map = maps_[number];
  if (!map || map->width() != size || map->format() != format)
    map = std::make_unique<raster::DepthBuffer>(size, size, format);
  return *map;
}

raster::DepthLookup record_shadow_map(raster::Frame& frame, std::span<const PlacedObject> objects,
                                      const Light& light, const MapPlan& plan,
                                      raster::Filter filter, raster::DepthBuffer& map) {
  frame.begin_pass("shadow map: " + light.name, {.depth = &map});
  frame.clear({.depth = 1.0f});
  raster::State state = surface_state();
  state.depth = raster::DepthState{};
  state.polygon_offset = plan.offset;
  state.depth_range.far = static_cast<float>(kDepthFar);
  for (const PlacedObject& object : objects) {
    if (!object.object->casts) continue;
    // What of a closed body is turned from the light hides the same points, and never the lit side.
    // The map mirrors (LightView), so that side is the one that is in front here.
    state.cull =
        object.topology->faults.closed_manifold() ? raster::Cull::back : raster::Cull::none;
    PlacedObject seen = object;
    seen.clip_from_model = plan.clip_from_world * object.object->world_from_model;
    draw_depth(frame, seen, state);
  }
  // From [-1, 1] to [0, 1], and to [0, kDepthFar].
  const auto half_depth = static_cast<float>(0.5 * kDepthFar);
  glm::mat4 to_map(0.5f);
  to_map[2][2] = half_depth;
  to_map[3] = {0.5f, 0.5f, half_depth, 1.0f};
  return {.map = &map, .map_from_position = to_map * plan.clip_from_world, .filter = filter};
}

}  // namespace gnomon::pipeline
