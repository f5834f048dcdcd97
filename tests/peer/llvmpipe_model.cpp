#include "llvmpipe_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "raster/unorm.h"

namespace gnomon::peer {

using namespace gnomon::raster;

namespace {

/// The largest relative error of one float32 rounding.
constexpr double kU = 1.0 / (1 << 24);

/// A clip position and a bound of the error of each of its coordinates.
struct ClipCorner {
  glm::dvec4 position;
  double error = 0.0;
};

double magnitude(const glm::dvec4& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), std::abs(p.w)});
}

/// Mesa's planes in the order of its clip mask: x <= w, x >= -w, y <= w, y >= -w, z >= -w, z <= w.
constexpr int kPlanes = 6;

double distance(const glm::dvec4& p, int plane) {
  const double c = p[plane / 2];
  return plane == 0 || plane == 2 || plane == 5 ? p.w - c : p.w + c;
}

/// out + t (in - out) with t = d_out / (d_out - d_in): a dot product of rounded coordinates errs by
/// the coordinates' errors and four roundings, moves t by that over the distances' difference and
/// the point along the edge by t's error times the edge; product and sum round three times more.
ClipCorner cut(const ClipCorner& inner, double inner_distance, const ClipCorner& outer,
               double outer_distance) {
  const double t = outer_distance / (outer_distance - inner_distance);
  const glm::dvec4 edge = inner.position - outer.position;
  const double size = std::max(magnitude(inner.position), magnitude(outer.position));
  const double distance_error = 2.0 * std::max(inner.error, outer.error) + 4.0 * kU * size;
  const double t_error =
      2.0 * distance_error / std::abs(outer_distance - inner_distance) + 2.0 * kU;
  return {outer.position + edge * t, std::max(inner.error, outer.error) +
                                         t_error * magnitude(edge) +
                                         3.0 * kU * (size + magnitude(edge))};
}

std::vector<ClipCorner> cut_at(const std::vector<ClipCorner>& in, int plane) {
  std::vector<ClipCorner> out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const ClipCorner& a = in[i];
    const ClipCorner& b = in[(i + 1) % in.size()];
    const double da = distance(a.position, plane), db = distance(b.position, plane);
    if (da >= 0.0) out.push_back(a);
    if (da >= 0.0 && db < 0.0) out.push_back(cut(a, da, b, db));
    if (da < 0.0 && db >= 0.0) out.push_back(cut(b, db, a, da));
  }
  return out;
}

/// c / w times scale plus offset. The reciprocal, two products and a sum round once each.
struct Mapped {
  double value, error;
};

Mapped map_to_window(double c, double w, double clip_error, double scale, double offset) {
  const double ndc = c / w;
  const double moved = clip_error / w * (1.0 + std::abs(ndc));
  return {ndc * scale + offset, std::abs(scale) * (moved + 3.0 * kU * std::abs(ndc)) +
                                    kU * (std::abs(ndc * scale) + std::abs(offset))};
}

Corner to_window(const ClipCorner& corner, const DrawSetup& setup, int target_height) {
  const Rect& v = setup.viewport;
  const DepthRange& range = setup.draw->state.depth_range;
  const double near = range.near, far = range.far;
  const glm::dvec4& p = corner.position;
  const double half_width = 0.5 * v.width, half_height = 0.5 * v.height;
  const Mapped x = map_to_window(p.x, p.w, corner.error, half_width, v.x + half_width);
  const Mapped y = map_to_window(p.y, p.w, corner.error, half_height, v.y + half_height);
  const Mapped z = map_to_window(p.z, p.w, corner.error, 0.5 * (far - near), 0.5 * (far + near));
  // Mesa's window is upside down: the target's height takes the place of the offset.
  const double error_px = std::max(x.error, y.error + kU * target_height);
  return {{x.value, y.value}, z.value, error_px, z.error + kU};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::length(p - (a + t * along));
}

/// Half of 1/256 pixel.
constexpr double kHalfStep = 0.5 / 256.0;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Depths, what half a step of the snap rises, and the larger slope.
struct Interval {
  double low = 0.0, high = 0.0, snap = 0.0, slope_low = 0.0, slope_high = 0.0;
};

constexpr Interval kAnyDepth{-kInfinity, kInfinity, kInfinity, 0.0, kInfinity};

/// Slopes of depth a pixel along x and y, and bounds of their errors where the corners' coordinates
/// err by error_px and their depths by error_depth. Slopes are numerator / area; both are sums of
/// products of differences, so their errors are those of the differences times the other factors.
struct Slopes {
  glm::dvec2 value{0.0}, error{0.0};
};

Slopes slopes_of(const std::array<Corner, 3>& c, double error_px, double error_depth) {
  const glm::dvec2 d1 = c[1].window_px - c[0].window_px, d2 = c[2].window_px - c[0].window_px;
  const double z1 = c[1].depth - c[0].depth, z2 = c[2].depth - c[0].depth;
  const double area = cross(d1, d2);
  const double span = std::abs(d1.x) + std::abs(d1.y) + std::abs(d2.x) + std::abs(d2.y);
  const double rise = std::abs(z1) + std::abs(z2);
  const double de = 2.0 * error_px + kU * span, dz = 2.0 * error_depth + kU * rise;
  const double area_error = span * de + 2.0 * de * de + 3.0 * kU * span * span;
  const double numerator_error = rise * de + span * dz + 2.0 * de * dz + 4.0 * kU * rise * span;
  // Where the area's error reaches half of the area nothing is left of the slopes.
  if (area_error >= 0.5 * std::abs(area)) return {{}, glm::dvec2(kInfinity)};
  const glm::dvec2 slope = glm::dvec2(z1 * d2.y - z2 * d1.y, z2 * d1.x - z1 * d2.x) / area;
  return {slope, (glm::dvec2(numerator_error) + glm::abs(slope) * area_error) /
                     (std::abs(area) - area_error)};
}

/// The depth of the plane through three corners at a point, polygon offset included: value at the
/// origin and slopes as lp_state_setup.c computes them.
Interval plane_at(const std::array<Corner, 3>& c, const glm::dvec2& point,
                  const std::optional<PolygonOffset>& offset, double origin_px) {
  double e = 0.0, ez = 0.0, reach = origin_px, highest = 0.0;
  for (const Corner& corner : c) {
    e = std::max(e, corner.error_px);
    ez = std::max(ez, corner.error_depth);
    reach = std::max({reach, std::abs(corner.window_px.x), std::abs(corner.window_px.y)});
    highest = std::max(highest, std::abs(corner.depth));
  }
  const Slopes slopes = slopes_of(c, e, ez);
  if (slopes.error.x == kInfinity) return kAnyDepth;
  const glm::dvec2 size = glm::abs(slopes.value), from = point - c[0].window_px;
  const double steepness = size.x + size.y;
  double value = c[0].depth + glm::dot(slopes.value, from);
  // Six roundings on the way from corner 0 to the origin and on to the pixel.
  double error = ez + steepness * e + glm::dot(slopes.error, glm::abs(from)) +
                 6.0 * kU * (highest + 2.0 * reach * (steepness + slopes.error.x + slopes.error.y));
  const double slope = std::max(size.x, size.y);
  const double slope_error = std::max(slopes.error.x, slopes.error.y);
  if (offset) {
    const double factor = offset->factor, units = static_cast<double>(offset->units) * kU;
    const double moved = factor * slope + units;
    value += moved;
    error += std::abs(factor) * slope_error + 4.0 * kU * (std::abs(moved) + std::abs(units));
  }
  return {value - error, value + error, steepness * kHalfStep, slope - slope_error,
          slope + slope_error};
}

}  // namespace

Outline clipped_outline(const DrawSetup& setup, const std::array<glm::vec4, 3>& clip,
                        int target_height) {
  std::vector<ClipCorner> polygon;
  for (const glm::vec4& p : clip) polygon.push_back({glm::dvec4(p), 0.0});
  for (int plane = 0; plane < kPlanes && !polygon.empty(); ++plane) {
    if (plane >= 4 && setup.draw->state.depth_clamp) continue;
    polygon = cut_at(polygon, plane);
  }
  Outline outline;
  if (polygon.size() < 3) return outline;
  for (const ClipCorner& corner : polygon)
    outline.push_back(to_window(corner, setup, target_height));
  return outline;
}

double signed_area(const Outline& outline) {
  double sum = 0.0;
  for (std::size_t i = 2; i < outline.size(); ++i)
    sum += cross(outline[i - 1].window_px - outline[0].window_px,
                 outline[i].window_px - outline[0].window_px);
  return sum;
}

double edge_reach(const Corner& a, const Corner& b) {
  return std::sqrt(2.0) * (kHalfStep + std::max(a.error_px, b.error_px));
}

double clearance_px(const Outline& outline, const glm::dvec2& point) {
  double clearance = kInfinity;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Corner& a = outline[i];
    const Corner& b = outline[(i + 1) % outline.size()];
    clearance = std::min(clearance,
                         distance_to_segment(point, a.window_px, b.window_px) - edge_reach(a, b));
  }
  return clearance;
}

bool contains(const Outline& outline, const glm::dvec2& point) {
  // By parity of the edges that a ray to the right crosses: clipping leaves edges of no length,
  // whose directions mean nothing.
  bool inside = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2& a = outline[i].window_px;
    const glm::dvec2& b = outline[(i + 1) % outline.size()].window_px;
    if ((a.y > point.y) != (b.y > point.y) &&
        point.x < a.x + (b.x - a.x) * ((point.y - a.y) / (b.y - a.y)))
      inside = !inside;
  }
  return inside;
}

DepthBounds depth_bounds(const DrawSetup& setup, const Outline& outline, const glm::dvec2& point,
                         int target_height, DepthRounding rounding) {
  Interval all{kInfinity, -kInfinity, 0.0, kInfinity, 0.0};
  for (std::size_t i = 2; i < outline.size(); ++i) {
    const Outline piece{outline[0], outline[i - 1], outline[i]};
    if (!contains(piece, point) && clearance_px(piece, point) > 0.0) continue;
    const Interval one = plane_at({piece[0], piece[1], piece[2]}, point,
                                  setup.draw->state.polygon_offset, target_height);
    all.low = std::min(all.low, one.low);
    all.high = std::max(all.high, one.high);
    all.snap = std::max(all.snap, one.snap);
    all.slope_low = std::min(all.slope_low, one.slope_low);
    all.slope_high = std::max(all.slope_high, one.slope_high);
  }
  const double largest = max_depth(DepthFormat::d24);
  const State& state = setup.draw->state;
  const auto [near, far] = std::minmax(state.depth_range.near, state.depth_range.far);
  const double low = state.depth_clamp ? near : 0.0, high = state.depth_clamp ? far : 1.0;
  // Mesa's bounds of the clamp are the viewport's offset less and plus its scale, three roundings.
  const double clamp_error = state.depth_clamp ? 3.0 * kU * high : 0.0;
  // The product with 2^24 - 1 rounds once before it becomes an integer.
  const double half = rounding == DepthRounding::nearest ? 0.5 : 0.0;
  const auto to_units = [&](double depth, double way) {
    return std::floor(
        (std::clamp(depth, low, high) + clamp_error * way) * largest * (1.0 + way * kU) + half);
  };
  return {static_cast<std::uint32_t>(std::max(to_units(all.low, -1.0), 0.0)),
          static_cast<std::uint32_t>(std::min(to_units(all.high, 1.0), largest)),
          all.snap * largest + 1.0, all.slope_low * largest, all.slope_high * largest};
}

}  // namespace gnomon::peer
