#include "raster/geometry.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "raster/clip.h"
#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

/// Bound of a snapped coordinate: 65536 pixels, so that edge values stay below 2^53 and doubles
/// hold them exactly.
constexpr std::int64_t kMaxCoordinate = std::int64_t{1} << 24;
/// The guard band reaches this many pixels beyond the viewport's centre.
constexpr double kGuardPixels = 16384.0;

struct ProjectedVertex {
  SnappedVertex snapped;
  double inverse_w = 1.0;
  glm::dvec3 weights{0.0};
};

std::int32_t snap(double window) {
  constexpr auto kLimit = static_cast<double>(kMaxCoordinate);
  return static_cast<std::int32_t>(round_to_nearest(std::clamp(window * 256.0, -kLimit, kLimit)));
}

std::int64_t snap_depth(double depth, const DrawSetup& setup) {
  const int fraction_bits = depth_fraction_bits(setup.depth_format);
  const double one = static_cast<double>(static_cast<std::int64_t>(max_depth(setup.depth_format))
                                         << fraction_bits);
  const double limit = static_cast<double>(kMaxVertexDepth);
  const std::int64_t z_fx = round_to_nearest(std::clamp(depth * one, -limit, limit));
  if (setup.draw->state.depth_clamp) return z_fx;
  // Clipping has left nothing outside the depth range but its own rounding.
  return std::clamp(z_fx, static_cast<std::int64_t>(0), static_cast<std::int64_t>(one));
}

ProjectedVertex project(const glm::dvec4& clip, const glm::dvec3& weights, const DrawSetup& setup) {
  const Rect& viewport = setup.viewport;
  const DepthRange& range = setup.draw->state.depth_range;
  const double half_width = viewport.width * 0.5, half_height = viewport.height * 0.5;
  const double half_depth =
      (static_cast<double>(range.far) - static_cast<double>(range.near)) * 0.5;
  const double mid_depth = (static_cast<double>(range.far) + static_cast<double>(range.near)) * 0.5;
  ProjectedVertex out;
  out.snapped.x_fx = snap((clip.x / clip.w) * half_width + (viewport.x + half_width));
  out.snapped.y_fx = snap((clip.y / clip.w) * half_height + (viewport.y + half_height));
  out.snapped.z_fx = snap_depth((clip.z / clip.w) * half_depth + mid_depth, setup);
  out.inverse_w = 1.0 / clip.w;
  out.weights = weights;
  return out;
}

/// First pixel whose centre is at or after a 24.8 coordinate.
int first_pixel(std::int32_t fx) { return (fx + 127) >> 8; }
/// One past the last pixel whose centre is at or before it.
int end_pixel(std::int32_t fx) { return ((fx - 128) >> 8) + 1; }

bool culled(Cull cull, bool front_facing) {
  return cull == Cull::front_and_back || (cull == Cull::front && front_facing) ||
         (cull == Cull::back && !front_facing);
}

/// Sets up one snapped triangle; false if it covers no pixel or is culled.
bool set_up(const DrawSetup& setup, std::array<ProjectedVertex, 3> v, std::uint32_t first_index,
            SetupTriangle& out) {
  const auto [x_min, x_max] =
      std::minmax({v[0].snapped.x_fx, v[1].snapped.x_fx, v[2].snapped.x_fx});
  const auto [y_min, y_max] =
      std::minmax({v[0].snapped.y_fx, v[1].snapped.y_fx, v[2].snapped.y_fx});
  out.box = intersect(setup.box,
                      {first_pixel(x_min), first_pixel(y_min), end_pixel(x_max), end_pixel(y_max)});
  if (out.box.empty()) return false;

  const std::int64_t dx1 = v[1].snapped.x_fx - v[0].snapped.x_fx;
  const std::int64_t dy1 = v[1].snapped.y_fx - v[0].snapped.y_fx;
  const std::int64_t dx2 = v[2].snapped.x_fx - v[0].snapped.x_fx;
  const std::int64_t dy2 = v[2].snapped.y_fx - v[0].snapped.y_fx;
  std::int64_t area = dx1 * dy2 - dx2 * dy1;
  if (area == 0) return false;
  const State& state = setup.draw->state;
  out.front_facing = (area > 0) == (state.front_face == FrontFace::ccw);
  if (culled(state.cull, out.front_facing)) return false;
  if (area < 0) {
    std::swap(v[1], v[2]);
    area = -area;
  }

  for (std::size_t k = 0; k < 3; ++k) {
    const SnappedVertex& from = v[(k + 1) % 3].snapped;
    const SnappedVertex& to = v[(k + 2) % 3].snapped;
    const std::int32_t dx = to.x_fx - from.x_fx, dy = to.y_fx - from.y_fx;
    out.a[k] = -dy;
    out.b[k] = dx;
    out.c[k] =
        static_cast<std::int64_t>(dy) * from.x_fx - static_cast<std::int64_t>(dx) * from.y_fx;
    // Counter-clockwise with y upwards: a left edge goes down, a bottom edge goes right.
    out.bias[k] = dy < 0 || (dy == 0 && dx > 0) ? 0 : 1;
    out.attributes.inverse_w[k] = v[k].inverse_w;
    out.attributes.weights[k] = v[k].weights;
  }
  out.attributes.first_index = first_index;
  out.depth =
      make_depth_plane({v[0].snapped, v[1].snapped, v[2].snapped}, area, state.polygon_offset,
                       setup.depth_format, setup.depth_low, setup.depth_high);
  return true;
}

bool before(const ProjectedVertex& a, const ProjectedVertex& b) {
  const auto key = [](const ProjectedVertex& v) {
    return std::tuple(v.snapped.x_fx, v.snapped.y_fx, v.snapped.z_fx);
  };
  return key(a) < key(b);
}

bool finite(const glm::vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

}  // namespace

PixelBox intersect(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

PixelBox scissor_box(const std::optional<Rect>& scissor, int width, int height) {
  const PixelBox all{0, 0, width, height};
  if (!scissor) return all;
  const auto end = [](int start, int size) {
    return static_cast<int>(
        std::clamp<std::int64_t>(static_cast<std::int64_t>(start) + size, 0, kMaxTargetSize));
  };
  return intersect(all, {scissor->x, scissor->y, end(scissor->x, scissor->width),
                         end(scissor->y, scissor->height)});
}

DrawSetup make_draw_setup(const Draw& draw, const Targets& targets) {
  const int width = targets.width(), height = targets.height();
  DrawSetup setup;
  setup.draw = &draw;
  setup.depth_format = targets.depth ? targets.depth->format() : DepthFormat::d24;
  setup.viewport = draw.state.viewport.value_or(Rect{0, 0, width, height});
  setup.box = intersect(scissor_box(draw.state.scissor, width, height),
                        scissor_box(setup.viewport, width, height));
  const auto [low, high] = std::minmax(draw.state.depth_range.near, draw.state.depth_range.far);
  setup.depth_low = draw.state.depth_clamp ? float_to_depth(low, setup.depth_format) : 0;
  setup.depth_high = draw.state.depth_clamp ? float_to_depth(high, setup.depth_format)
                                            : max_depth(setup.depth_format);
  return setup;
}

void set_up_triangles(const DrawSetup& setup, std::span<const glm::vec4> clip, std::size_t first,
                      std::size_t count, std::vector<SetupTriangle>& out) {
  const std::span<const std::uint32_t> indices = setup.draw->mesh.indices;
  const ClipVolume volume{2.0 * kGuardPixels / setup.viewport.width,
                          2.0 * kGuardPixels / setup.viewport.height,
                          !setup.draw->state.depth_clamp};
  SetupTriangle triangle;
  for (std::size_t t = first; t < first + count; ++t) {
    const auto first_index = static_cast<std::uint32_t>(3 * t);
    const std::array<glm::vec4, 3> p{clip[indices[3 * t]], clip[indices[3 * t + 1]],
                                     clip[indices[3 * t + 2]]};
    if (!finite(p[0]) || !finite(p[1]) || !finite(p[2])) continue;
    if (volume.contains(p[0]) && volume.contains(p[1]) && volume.contains(p[2])) {
      const std::array<ProjectedVertex, 3> v{project(p[0], {1.0, 0.0, 0.0}, setup),
                                             project(p[1], {0.0, 1.0, 0.0}, setup),
                                             project(p[2], {0.0, 0.0, 1.0}, setup)};
      if (set_up(setup, v, first_index, triangle)) out.push_back(triangle);
      continue;
    }
    const ClippedPolygon polygon = clip_triangle(p, volume);
    const auto corners = static_cast<std::size_t>(polygon.count);
    std::array<ProjectedVertex, 10> v;
    for (std::size_t i = 0; i < corners; ++i)
      v[i] = project(polygon.vertices[i].position, polygon.vertices[i].weights, setup);
    // The fan starts at one and the same vertex however the triangle was given, so its pieces, and
    // with them its depth bits, do not depend on the order of its vertices or on its winding.
    if (corners > 3)
      std::rotate(v.begin(), std::min_element(v.begin(), v.begin() + corners, before),
                  v.begin() + corners);
    for (std::size_t i = 2; i < corners; ++i)
      if (set_up(setup, {v[0], v[i - 1], v[i]}, first_index, triangle)) out.push_back(triangle);
  }
}

}  // namespace gnomon::raster
