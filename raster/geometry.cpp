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

ProjectedVertex project(const glm::dvec4& clip, const DrawSetup& setup) {
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

/// A corner of a polygon that clipping left.
struct Corner {
  ProjectedVertex vertex;
  glm::dvec3 weights{0.0};
};

/// No pixel centre of a tiny box lies inside the triangle, whose vertices go counter-clockwise.
bool misses_all(const SetupTriangle& triangle) {
  constexpr int kTiny = 2;
  if (triangle.x1 - triangle.x0 > kTiny || triangle.y1 - triangle.y0 > kTiny) return false;
  for (int y = triangle.y0; y < triangle.y1; ++y)
    for (int x = triangle.x0; x < triangle.x1; ++x)
      if (triangle.covers(x, y)) return false;
  return true;
}

/// Sets up one snapped triangle; false if it covers no pixel or is culled.
bool set_up(const DrawSetup& setup, const ProjectedVertex& v0, const ProjectedVertex& v1,
            const ProjectedVertex& v2, SetupTriangle& out) {
  const SnappedVertex &s0 = v0.snapped, &s1 = v1.snapped, &s2 = v2.snapped;
  const std::int64_t area = doubled_area(s0, s1, s2);
  if (area == 0) return false;
  const State& state = setup.draw->state;
  out.front_facing = (area > 0) == (state.front_face == FrontFace::ccw);
  if (culled(state.cull, out.front_facing)) return false;
  const auto [x_min, x_max] = std::minmax({s0.x_fx, s1.x_fx, s2.x_fx});
  const auto [y_min, y_max] = std::minmax({s0.y_fx, s1.y_fx, s2.y_fx});
  const PixelBox box = intersect(
      setup.box, {first_pixel(x_min), first_pixel(y_min), end_pixel(x_max), end_pixel(y_max)});
  if (box.empty()) return false;
  out.x0 = static_cast<std::int16_t>(box.x0);
  out.y0 = static_cast<std::int16_t>(box.y0);
  out.x1 = static_cast<std::int16_t>(box.x1);
  out.y1 = static_cast<std::int16_t>(box.y1);
  out.small =
      x_max - x_min < SetupTriangle::kSmall * 256 && y_max - y_min < SetupTriangle::kSmall * 256;
  out.swapped = area < 0;
  out.vertices = {s0, out.swapped ? s2 : s1, out.swapped ? s1 : s2};
  if (misses_all(out)) return false;
  const DepthPlane plane = make_depth_plane(out.vertices, std::abs(area), state.polygon_offset,
                                            setup.depth_format, setup.depth_low, setup.depth_high);
  out.step_x = plane.step_x;
  out.step_y = plane.step_y;
  out.narrow = plane.narrow;
  for (SnappedVertex& vertex : out.vertices) vertex.z_fx += plane.offset;
  return true;
}

bool before(const Corner& a, const Corner& b) {
  const auto key = [](const Corner& corner) {
    const SnappedVertex& v = corner.vertex.snapped;
    return std::tuple(v.x_fx, v.y_fx, v.z_fx);
  };
  return key(a) < key(b);
}

bool finite(const glm::vec4& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

ClipVolume clip_volume(const DrawSetup& setup) {
  return {2.0 * kGuardPixels / setup.viewport.width, 2.0 * kGuardPixels / setup.viewport.height,
          !setup.draw->state.depth_clamp};
}

/// Appends the pieces that clipping leaves of a triangle; `triangle` names the mesh's one.
void set_up_pieces(const DrawSetup& setup, const ClipVolume& volume,
                   const std::array<glm::vec4, 3>& clip, SetupTriangle triangle,
                   SetupTriangles& out) {
  const ClippedPolygon polygon = clip_triangle(clip, volume);
  const auto count = static_cast<std::size_t>(polygon.count);
  std::array<Corner, 10> corners;
  for (std::size_t i = 0; i < count; ++i)
    corners[i] = {project(polygon.vertices[i].position, setup), polygon.vertices[i].weights};
  // The fan starts at one and the same vertex however the triangle was given, so its pieces, and
  // with them its depth bits, do not depend on the order of its vertices or on its winding.
  if (count > 3)
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.begin() + count, before),
                corners.begin() + count);
  for (std::size_t i = 2; i < count; ++i) {
    const std::array<const Corner*, 3> piece{&corners[0], &corners[i - 1], &corners[i]};
    if (!set_up(setup, piece[0]->vertex, piece[1]->vertex, piece[2]->vertex, triangle)) continue;
    triangle.piece = static_cast<std::uint32_t>(out.pieces.size());
    const Corner &second = *piece[triangle.swapped ? 2 : 1],
                 &third = *piece[triangle.swapped ? 1 : 2];
    out.pieces.push_back(
        {{corners[0].vertex.inverse_w, second.vertex.inverse_w, third.vertex.inverse_w},
         {corners[0].weights, second.weights, third.weights}});
    out.triangles.push_back(triangle);
  }
}

}  // namespace

bool SetupTriangle::covers(int x, int y) const {
  if (x < x0 || y < y0 || x >= x1 || y >= y1) return false;
  for (int k = 0; k < 3; ++k) {
    const Edge e = edge(k);
    if (e.at(x * std::int64_t{256} + 128, y * std::int64_t{256} + 128) < e.bias()) return false;
  }
  return true;
}

std::uint32_t SetupTriangle::depth_at(int x, int y, const DrawSetup& setup) const {
  const int in_x = x % kTileSize, in_y = y % kTileSize;
  const int bits = depth_fraction_bits(setup.depth_format);
  const std::uint64_t value = depth_base_at(vertices, area(), x - in_x, y - in_y) +
                              static_cast<std::uint64_t>(in_x) * step_x +
                              static_cast<std::uint64_t>(in_y) * step_y +
                              (std::uint64_t{1} << (bits - 1));
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(
      static_cast<std::int64_t>(value) >> bits, setup.depth_low, setup.depth_high));
}

std::array<double, 3> TriangleSource::inverse_w(const SetupTriangle& triangle,
                                                std::span<const std::uint32_t> indices) const {
  if (triangle.piece != SetupTriangle::kWhole) return pieces[triangle.piece].inverse_w;
  const auto of = [&](std::uint32_t corner) {
    return vertices[indices[triangle.first_index + corner]].inverse_w;
  };
  return {of(0), of(triangle.swapped ? 2 : 1), of(triangle.swapped ? 1 : 2)};
}

DepthInterval vertex_depths(const SetupTriangle& triangle, const DrawSetup& setup) {
  const auto& v = triangle.vertices;
  const auto [least, greatest] = std::minmax({v[0].z_fx, v[1].z_fx, v[2].z_fx});
  const int bits = depth_fraction_bits(setup.depth_format);
  const std::int64_t half = std::int64_t{1} << (bits - 1);
  const auto units = [&](std::int64_t value) {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>((value + half) >> bits, setup.depth_low, setup.depth_high));
  };
  return {units(least - kPlaneError), units(greatest + kPlaneError)};
}

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

void project_vertices(const DrawSetup& setup, DrawVertices& vertices, std::size_t first,
                      std::size_t last) {
  const ClipVolume volume = clip_volume(setup);
  for (std::size_t i = first; i < last; ++i) {
    const glm::vec4& clip = vertices.clip[i];
    vertices.places[i] = !finite(clip)           ? VertexPlace::not_finite
                         : volume.contains(clip) ? VertexPlace::inside
                                                 : VertexPlace::outside;
    if (vertices.places[i] == VertexPlace::inside) vertices.projected[i] = project(clip, setup);
  }
}

void set_up_triangles(const DrawSetup& setup, const DrawVertices& vertices, std::size_t first,
                      std::size_t count, SetupTriangles& out) {
  const std::uint32_t* const indices = setup.draw->mesh.indices.data();
  const ClipVolume volume = clip_volume(setup);
  SetupTriangle triangle;
  for (std::size_t t = first; t < first + count; ++t) {
    const std::uint32_t *const corner = indices + 3 * t, a = corner[0], b = corner[1],
                               c = corner[2];
    const VertexPlace worst =
        std::max({vertices.places[a], vertices.places[b], vertices.places[c]});
    if (worst == VertexPlace::not_finite) continue;
    triangle.first_index = static_cast<std::uint32_t>(3 * t);
    if (worst == VertexPlace::outside) {
      set_up_pieces(setup, volume, {vertices.clip[a], vertices.clip[b], vertices.clip[c]}, triangle,
                    out);
      continue;
    }
    triangle.piece = SetupTriangle::kWhole;
    if (set_up(setup, vertices.projected[a], vertices.projected[b], vertices.projected[c],
               triangle))
      out.triangles.push_back(triangle);
  }
}

}  // namespace gnomon::raster
