// Proof that counts outside the window are 0 anyway. Let q be the visible receiver point of a
// pixel, V the closed infinite volume, and the count a sound one (z-fail, or z-pass with the near
// region clear of V). In exact geometry the faces between eye and q (behind q, for z-fail) add up
// to 0 unless q is in V. The rasterizer's faces are a closed chain too, so only the order in depth
// of a face and q can differ from that. It does by no more than: corners snapped by half of 1/256
// pixel in x and y (a point of a snapped triangle moves by no more than its corners), float32's
// rounding of corners (1e-7 of the distance), and the rounding of two depths to the buffer's units.
// So a count that is not 0 needs q within that distance of V. Here V is widened by two pixels' and
// eight units' worth of metres at the receiver's farthest point, hundreds of times the former and
// four times the latter, and by 1e-5 of the distance from the light; receivers are cut to that, and
// what is left is projected and has two pixels round it. At a receiver that the far plane reaches,
// depths are clamped to one value and nothing is within any distance: then there is no window.
// Before the near plane all depths are 0: no face passes LESS there, all fail, and both counts are
// 0 for any closed volume.
// V lies in the pyramid (for a direction, the prism) that the light and the caster's bounds span,
// behind the bounds' nearest corner.
#include "pipeline/volume_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "pipeline/basis.h"

namespace gnomon::pipeline {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Of slopes, and of the distance across a direction.
constexpr double kWiden = 1e-5;
constexpr double kPadPixels = 2.0, kPadUnits = 8.0;
/// Of a corner's distance from the world's origin: ten times float32's rounding.
constexpr double kPadRounding = 1e-6;
/// Receivers with no more triangles are not replaced by their bounds.
constexpr std::size_t kFewTriangles = 4;

/// The half space dot(normal, p) >= offset, normal of unit length.
struct HalfSpace {
  glm::dvec3 normal{0.0};
  double offset = 0.0;
  double of(const glm::dvec3& p) const { return glm::dot(normal, p) - offset; }
};

HalfSpace half_space(const glm::dvec3& normal, const glm::dvec3& through) {
  const glm::dvec3 unit = normal / glm::length(normal);
  return {unit, glm::dot(unit, through)};
}

/// A convex polygon with room for every plane that cuts it.
struct Polygon {
  std::array<glm::dvec3, 24> points;
  std::size_t count = 0;
  void add(const glm::dvec3& p) {
    if (count < points.size()) points[count++] = p;
  }
};

/// The part of the polygon where half.of(p) + pad is not negative.
void clip(Polygon& polygon, const HalfSpace& half, double pad) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const glm::dvec3& p = polygon.points[i];
    const glm::dvec3& q = polygon.points[(i + 1) % polygon.count];
    const double dp = half.of(p) + pad, dq = half.of(q) + pad;
    if (dp >= 0.0) kept.add(p);
    if ((dp >= 0.0) != (dq >= 0.0)) kept.add(p + (q - p) * (dp / (dp - dq)));
  }
  polygon = kept;
}

using Corners = std::array<glm::dvec3, 8>;

Corners corners_of(const glm::dvec3& low, const glm::dvec3& high, const glm::dmat4& world) {
  Corners corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const glm::dvec3 p(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    corners[i] = glm::dvec3(world * glm::dvec4(p, 1.0));
  }
  return corners;
}

/// A bounds' six faces, as indices of corners round each.
constexpr std::array<std::array<std::size_t, 4>, 6> kFaces = {
    {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};

/// What holds a caster's infinite volume: four sides and, nearest to the light, a front; its part
/// of the front's plane is the rectangle between low and high in the basis' u and v.
struct Region {
  bool everywhere = false;
  Basis basis{};
  /// The basis' origin: the light, or 0 for a direction.
  glm::dvec3 origin{0.0};
  bool pyramid = false;
  /// Slopes for a pyramid, coordinates for a prism; of the front along the axis.
  glm::dvec2 low{kInfinity}, high{-kInfinity};
  double front = kInfinity;
  std::array<HalfSpace, 5> halves;
};

Region region_of(const glm::vec4& light_world, const Corners& caster) {
  Region region;
  const glm::dvec3 light(light_world);
  region.pyramid = light_world.w != 0.0f;
  glm::dvec3 middle(0.0);
  for (const glm::dvec3& p : caster) middle += p * 0.125;
  const glm::dvec3 along = region.pyramid ? middle - light : -light;
  const double distance = glm::length(along);
  if (!(distance > 0.0)) return {.everywhere = true};
  region.basis = basis_about(along / distance);
  if (region.pyramid) region.origin = light;
  double farthest = 0.0;
  for (const glm::dvec3& p : caster) {
    const glm::dvec3 q = region.basis(p - region.origin);
    region.front = std::min(region.front, q.z);
    farthest = std::max(farthest, glm::length(q));
    const glm::dvec2 at = region.pyramid ? glm::dvec2(q) / q.z : glm::dvec2(q);
    region.low = glm::min(region.low, at);
    region.high = glm::max(region.high, at);
  }
  // The light is among the bounds, or so near that slopes are steep.
  if (region.pyramid && !(region.front > 1e-2 * farthest)) return {.everywhere = true};
  const double widen = region.pyramid ? kWiden : kWiden * farthest;
  region.low -= widen;
  region.high += widen;
  region.front -= kWiden * farthest;
  const auto& [u, v, axis] = region.basis;
  const glm::dvec3 corner = region.origin + region.basis.axis * region.front;
  const glm::dvec2 slope_low = region.pyramid ? region.low : glm::dvec2(0.0);
  const glm::dvec2 slope_high = region.pyramid ? region.high : glm::dvec2(0.0);
  const double scale = region.pyramid ? region.front : 1.0;
  region.halves = {half_space(axis, corner),
                   half_space(u - slope_low.x * axis, corner + u * (region.low.x * scale)),
                   half_space(slope_high.x * axis - u, corner + u * (region.high.x * scale)),
                   half_space(v - slope_low.y * axis, corner + v * (region.low.y * scale)),
                   half_space(slope_high.y * axis - v, corner + v * (region.high.y * scale))};
  return region;
}

/// The region's front face, when every half space is widened by pad; not for one that reaches the
/// light.
std::optional<Polygon> front_face(const Region& region, double pad) {
  const double front = region.front - pad;
  if (region.pyramid && !(front > 0.0)) return std::nullopt;
  const auto widened = [&](double at, double sign) {
    return region.pyramid ? at * front + sign * pad * std::sqrt(1.0 + at * at) : at + sign * pad;
  };
  const double u0 = widened(region.low.x, -1.0), u1 = widened(region.high.x, 1.0);
  const double v0 = widened(region.low.y, -1.0), v1 = widened(region.high.y, 1.0);
  Polygon polygon;
  for (const glm::dvec2& at :
       {glm::dvec2(u0, v0), glm::dvec2(u1, v0), glm::dvec2(u1, v1), glm::dvec2(u0, v1)}) {
    polygon.add(region.origin + region.basis.u * at.x + region.basis.v * at.y +
                region.basis.axis * front);
  }
  return polygon;
}

/// Collects polygons' projections.
class Window {
 public:
  explicit Window(const View& view)
      : view_(view), rows_(glm::transpose(glm::dmat4(view.clip_from_world))) {}

  void add(const Polygon& polygon) {
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const glm::dvec4 a(polygon.points[i], 1.0);
      const glm::dvec4 b(polygon.points[(i + 1) % polygon.count], 1.0);
      const double wa = glm::dot(rows_[3], a), wb = glm::dot(rows_[3], b);
      if (wa >= kNear) add_point(a);
      if ((wa >= kNear) != (wb >= kNear)) add_point(a + (b - a) * ((kNear - wa) / (wb - wa)));
    }
  }
  bool full() const {
    return low_.x <= 0.0 && low_.y <= 0.0 && high_.x >= view_.width && high_.y >= view_.height;
  }
  raster::Rect rect() const {
    if (!(low_.x <= high_.x)) return {};
    const auto pixel = [](double at, int size) {
      return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(size)));
    };
    const int x0 = pixel(std::floor(low_.x), view_.width);
    const int y0 = pixel(std::floor(low_.y), view_.height);
    const int x1 = pixel(std::ceil(high_.x), view_.width);
    const int y1 = pixel(std::ceil(high_.y), view_.height);
    if (x1 <= x0 || y1 <= y0) return {};
    return {x0, y0, x1 - x0, y1 - y0};
  }

 private:
  /// What is nearer to the eye plane is cut off when it is drawn (raster::kMinW).
  static constexpr double kNear = 1.0 / (1 << 24);

  void add_point(const glm::dvec4& p) {
    const double w = std::max(glm::dot(rows_[3], p), kNear);
    const glm::dvec2 at((glm::dot(rows_[0], p) / w + 1.0) * 0.5 * view_.width,
                        (glm::dot(rows_[1], p) / w + 1.0) * 0.5 * view_.height);
    low_ = glm::min(low_, at - kPadPixels);
    high_ = glm::max(high_, at + kPadPixels);
  }

  const View& view_;
  glm::dmat4 rows_;
  glm::dvec2 low_{kInfinity}, high_{-kInfinity};
};

void add_clipped(Polygon polygon, const Region& region, double pad, Window& window) {
  for (const HalfSpace& half : region.halves) {
    if (polygon.count == 0) return;
    clip(polygon, half, pad);
  }
  window.add(polygon);
}

/// Adds the common part of bounds and region. Its vertices are those of the bounds' faces cut to
/// the region and of the region's front cut to the bounds.
void add_bounds(const Corners& corners, const Region& region, double pad, Window& window) {
  glm::dvec3 center(0.0);
  for (const glm::dvec3& p : corners) center += p * 0.125;
  std::optional<Polygon> front = front_face(region, pad);
  for (const auto& face : kFaces) {
    Polygon polygon;
    for (const std::size_t i : face) polygon.add(corners[i]);
    if (!front) {
      window.add(polygon);
      continue;
    }
    const glm::dvec3 normal =
        glm::cross(corners[face[1]] - corners[face[0]], corners[face[3]] - corners[face[0]]);
    if (glm::length(normal) > 0.0 && front->count > 0) {
      const HalfSpace outer = half_space(normal, corners[face[0]]);
      const bool flip = outer.of(center) < 0.0;
      clip(*front, flip ? HalfSpace{-outer.normal, -outer.offset} : outer, pad);
    }
    add_clipped(polygon, region, pad, window);
  }
  if (front) window.add(*front);
}

}  // namespace

ReceiversInView::ReceiversInView(std::span<const PlacedObject> objects, const View& view)
    : view_(view), rows_(glm::transpose(glm::dmat4(view.clip_from_world))) {
  for (const PlacedObject& object : objects) {
    if (object.object->receives && object.topology->triangle_count() > 0) add(object);
  }
}

void ReceiversInView::add(const PlacedObject& object) {
  const Topology& topology = *object.topology;
  const glm::dmat4 world(object.object->world_from_model);
  Receiver receiver;
  receiver.corners = corners_of(topology.low, topology.high, world);
  if (!in_view(receiver.corners)) return;
  const std::optional<double> pad = pad_of(receiver.corners);
  if (!pad) {
    unbounded_ = true;
    return;
  }
  receiver.pad_m = *pad;
  for (const glm::dvec3& p : receiver.corners) receiver.center += p * 0.125;
  for (const glm::dvec3& p : receiver.corners) {
    receiver.radius = std::max(receiver.radius, glm::length(p - receiver.center));
  }
  if (topology.triangle_count() <= kFewTriangles) {
    for (std::size_t t = 0; t < topology.triangle_count(); ++t) {
      auto& triangle = receiver.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] =
            glm::dvec3(world * glm::dvec4(topology.positions[topology.indices[3 * t + k]]));
      }
    }
  }
  receivers_.push_back(std::move(receiver));
}

bool ReceiversInView::in_view(const Corners& corners) const {
  const std::array<glm::dvec4, 5> planes = {rows_[3], rows_[3] + rows_[0], rows_[3] - rows_[0],
                                            rows_[3] + rows_[1], rows_[3] - rows_[1]};
  return std::all_of(planes.begin(), planes.end(), [&](const glm::dvec4& plane) {
    return std::any_of(corners.begin(), corners.end(), [&](const glm::dvec3& p) {
      return !(glm::dot(plane, glm::dvec4(p, 1.0)) <= 0.0);
    });
  });
}

std::optional<double> ReceiversInView::pad_of(const Corners& corners) const {
  double w = 0.0;
  for (const glm::dvec3& p : corners) w = std::max(w, glm::dot(rows_[3], glm::dvec4(p, 1.0)));
  // Depth is a + b / w where planes of equal depth are planes of equal w.
  const glm::dvec3 along(rows_[3]);
  const double square = glm::dot(along, along);
  if (!(square > 0.0)) return std::nullopt;
  const double a = glm::dot(glm::dvec3(rows_[2]), along) / square, b = rows_[2].w - a * rows_[3].w;
  const double skew = glm::length(glm::dvec3(rows_[2]) - a * along);
  if (!(skew <= 1e-5 * std::sqrt(square)) || !(b < 0.0) || !std::isfinite(w)) return std::nullopt;
  const double units =
      0.5 * ((1 << (view_.depth_format == raster::DepthFormat::d24 ? 24 : 16)) - 1);
  if (!((1.0 - (a + b / w)) * units > kPadUnits)) return std::nullopt;
  const double unit_m = w * w / (-b * units * std::sqrt(square));
  double pixel_m = 0.0;
  for (const int row : {0, 1}) {
    const glm::dvec3 across(rows_[row]);
    const double per_m = glm::length(across - along * (glm::dot(across, along) / square));
    pixel_m = std::max(pixel_m, 2.0 * w / (per_m * (row == 0 ? view_.width : view_.height)));
  }
  double coordinate = 0.0;
  for (const glm::dvec3& p : corners) coordinate = std::max(coordinate, glm::length(p));
  const double pad = kPadPixels * pixel_m + kPadUnits * unit_m + kPadRounding * coordinate;
  if (!std::isfinite(pad)) return std::nullopt;
  return pad;
}

raster::Rect ReceiversInView::window_of(const glm::vec4& light_world, const Topology& caster,
                                        const glm::mat4& world_from_model) const {
  const raster::Rect all{0, 0, view_.width, view_.height};
  if (unbounded_) return all;
  const Region region =
      region_of(light_world, corners_of(caster.low, caster.high, glm::dmat4(world_from_model)));
  if (region.everywhere) return all;
  Window window(view_);
  for (const Receiver& receiver : receivers_) {
    const auto outside = [&](const HalfSpace& half) {
      return half.of(receiver.center) + receiver.radius + receiver.pad_m < 0.0;
    };
    if (std::any_of(region.halves.begin(), region.halves.end(), outside)) continue;
    if (receiver.triangles.empty()) add_bounds(receiver.corners, region, receiver.pad_m, window);
    for (const auto& triangle : receiver.triangles) {
      Polygon polygon;
      for (const glm::dvec3& p : triangle) polygon.add(p);
      add_clipped(polygon, region, receiver.pad_m, window);
    }
    if (window.full()) return all;
  }
  return window.rect();
}

}  // namespace gnomon::pipeline
