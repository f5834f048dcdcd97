#include "raster/geometry.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

/// The guard band reaches this many pixels beyond the viewport's centre.
constexpr double kGuardPixels = 16384.0;

/// A corner of a polygon that clipping left.
struct Corner {
  ProjectedVertex vertex;
  glm::dvec3 weights{0.0};
};

TriangleSelector selector_of(const DrawSetup& setup, const std::int32_t* x_fx,
                             const std::int32_t* y_fx, const std::int64_t* z_fx) {
  const State& state = setup.draw->state;
  const auto keeps = [&](bool front_facing) {
    return state.cull != Cull::front_and_back &&
           state.cull != (front_facing ? Cull::front : Cull::back);
  };
  const bool ccw_is_front = state.front_face == FrontFace::ccw;
  return {x_fx,
          y_fx,
          state.polygon_offset ? nullptr : z_fx,
          keeps(ccw_is_front),
          keeps(!ccw_is_front),
          setup.box};
}

/// Sets up triangle t of the batch, one that is kept, from its vertices.
void set_up(const DrawSetup& setup, const TriangleBatch& batch, std::size_t t,
            const SnappedVertex& v0, const SnappedVertex& v1, const SnappedVertex& v2,
            SetupTriangle& out) {
  const State& state = setup.draw->state;
  out.swapped = (batch.clockwise >> t & 1) != 0;
  out.front_facing = out.swapped == (state.front_face == FrontFace::cw);
  out.small = (batch.small >> t & 1) != 0;
  out.pixels = static_cast<TinyPixels>(batch.pixels[t]);
  out.x0 = static_cast<std::int16_t>(batch.x0[t]);
  out.y0 = static_cast<std::int16_t>(batch.y0[t]);
  out.x1 = static_cast<std::int16_t>(batch.x1[t]);
  out.y1 = static_cast<std::int16_t>(batch.y1[t]);
  out.vertices = {v0, out.swapped ? v2 : v1, out.swapped ? v1 : v2};
  out.has_base = (batch.planes >> t & 1) != 0;
  if (out.has_base) {
    out.step_x = static_cast<std::uint64_t>(batch.step_x[t]);
    out.step_y = static_cast<std::uint64_t>(batch.step_y[t]);
    out.base = static_cast<std::uint64_t>(batch.base[t]);
    out.narrow = is_narrow(out.vertices, 0, setup.depth_format, setup.depth_low, setup.depth_high);
    return;
  }
  const auto area = static_cast<std::int64_t>(std::abs(batch.area[t]));
  const DepthPlane plane = make_depth_plane(out.vertices, area, state.polygon_offset,
                                            setup.depth_format, setup.depth_low, setup.depth_high);
  out.step_x = plane.step_x;
  out.step_y = plane.step_y;
  out.narrow = plane.narrow;
  for (SnappedVertex& vertex : out.vertices) vertex.z_fx += plane.offset;
}

bool before(const Corner& a, const Corner& b) {
  const auto key = [](const Corner& corner) {
    const ProjectedVertex& v = corner.vertex;
    return std::tuple(v.x_fx, v.y_fx, v.z_fx);
  };
  return key(a) < key(b);
}

SnappedVertex snapped(const ProjectedVertex& vertex) {
  return {vertex.x_fx, vertex.y_fx, vertex.z_fx};
}

/// Appends the pieces that clipping leaves of a triangle; `triangle` names the mesh's one.
void set_up_pieces(const DrawSetup& setup, const std::array<glm::vec4, 3>& clip,
                   SetupTriangle triangle, SetupTriangles& out) {
  if (!std::all_of(clip.begin(), clip.end(), finite)) return;
  const ClippedPolygon polygon = clip_triangle(clip, setup.projection.volume);
  const auto count = static_cast<std::size_t>(polygon.count);
  std::array<Corner, 10> corners;
  for (std::size_t i = 0; i < count; ++i)
    corners[i] = {project(polygon.vertices[i].position, setup.projection),
                  polygon.vertices[i].weights};
  // The fan starts at one and the same vertex however the triangle was given, so its pieces, and
  // with them its depth bits, do not depend on the order of its vertices or on its winding.
  if (count > 3)
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.begin() + count, before),
                corners.begin() + count);
  for (std::size_t i = 2; i < count; ++i) {
    const std::array<const Corner*, 3> piece{&corners[0], &corners[i - 1], &corners[i]};
    std::array<std::int32_t, 3> x_fx, y_fx;
    for (std::size_t k = 0; k < 3; ++k) {
      x_fx[k] = piece[k]->vertex.x_fx;
      y_fx[k] = piece[k]->vertex.y_fx;
    }
    constexpr std::uint32_t kOne[3] = {0, 1, 2};
    TriangleBatch batch;
    select_triangles(selector_of(setup, x_fx.data(), y_fx.data(), nullptr), kOne, 1, batch);
    if (!batch.kept) continue;
    set_up(setup, batch, 0, snapped(piece[0]->vertex), snapped(piece[1]->vertex),
           snapped(piece[2]->vertex), triangle);
    triangle.piece = static_cast<std::uint32_t>(out.pieces.size());
    const Corner &second = *piece[triangle.swapped ? 2 : 1],
                 &third = *piece[triangle.swapped ? 1 : 2];
    out.pieces.push_back(
        {{corners[0].vertex.inverse_w, second.vertex.inverse_w, third.vertex.inverse_w},
         {corners[0].weights, second.weights, third.weights}});
    out.triangles.push_back(triangle);
  }
}

Projection make_projection(const Draw& draw, const Rect& viewport, DepthFormat format) {
  const State& state = draw.state;
  const auto near = static_cast<double>(state.depth_range.near),
             far = static_cast<double>(state.depth_range.far);
  Projection out;
  out.volume = {2.0 * kGuardPixels / viewport.width, 2.0 * kGuardPixels / viewport.height,
                !state.depth_clamp};
  out.scale_x = viewport.width * 0.5;
  out.scale_y = viewport.height * 0.5;
  out.scale_depth = (far - near) * 0.5;
  out.middle_x = viewport.x + out.scale_x;
  out.middle_y = viewport.y + out.scale_y;
  out.middle_depth = (far + near) * 0.5;
  out.one = static_cast<double>(static_cast<std::int64_t>(max_depth(format))
                                << depth_fraction_bits(format));
  // Without depth clamp, clipping has left nothing outside the depth range but its own rounding.
  out.highest = state.depth_clamp ? static_cast<double>(kMaxVertexDepth) : out.one;
  out.lowest = state.depth_clamp ? -out.highest : 0.0;
  return out;
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
    return inverse_w_of_vertex[indices[triangle.first_index + corner]];
  };
  return {of(0), of(triangle.swapped ? 2 : 1), of(triangle.swapped ? 1 : 2)};
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
  setup.projection = make_projection(draw, setup.viewport, setup.depth_format);
  const auto [low, high] = std::minmax(draw.state.depth_range.near, draw.state.depth_range.far);
  setup.depth_low = draw.state.depth_clamp ? float_to_depth(low, setup.depth_format) : 0;
  setup.depth_high = draw.state.depth_clamp ? float_to_depth(high, setup.depth_format)
                                            : max_depth(setup.depth_format);
  return setup;
}

void project_vertices(const Kernels& kernels, const DrawSetup& setup, DrawVertices& vertices,
                      std::size_t first, std::size_t last) {
  kernels.project(setup.projection, vertices.clip.data() + first, last - first,
                  {vertices.x_fx.data() + first, vertices.y_fx.data() + first,
                   vertices.z_fx.data() + first, vertices.inverse_w.data() + first});
}

void set_up_triangles(const Kernels& kernels, const DrawSetup& setup, const DrawVertices& vertices,
                      std::size_t first, std::size_t count, SetupTriangles& out) {
  const TriangleSelector selector =
      selector_of(setup, vertices.x_fx.data(), vertices.y_fx.data(), vertices.z_fx.data());
  const auto vertex = [&](std::uint32_t i) {
    return SnappedVertex{vertices.x_fx[i], vertices.y_fx[i], vertices.z_fx[i]};
  };
  SetupTriangle triangle;
  TriangleBatch batch;
  for (std::size_t start = first; start < first + count; start += kTriangleBatch) {
    const std::uint32_t* const indices = setup.draw->mesh.indices.data() + 3 * start;
    kernels.select_triangles(selector, indices, std::min(kTriangleBatch, first + count - start),
                             batch);
    for_each_bit(batch.kept | batch.clipped, [&](std::size_t t) {
      const std::uint32_t a = indices[3 * t], b = indices[3 * t + 1], c = indices[3 * t + 2];
      triangle.first_index = static_cast<std::uint32_t>(3 * (start + t));
      if (batch.clipped >> t & 1) {
        set_up_pieces(setup, {vertices.clip[a], vertices.clip[b], vertices.clip[c]}, triangle, out);
        return;
      }
      triangle.piece = SetupTriangle::kWhole;
      set_up(setup, batch, t, vertex(a), vertex(b), vertex(c), triangle);
      out.triangles.push_back(triangle);
    });
  }
}

}  // namespace gnomon::raster
