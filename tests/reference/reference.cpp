#include "reference/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "reference/fragment.h"

namespace gnomon::reference {

namespace {

using namespace gnomon::raster;
__extension__ typedef __int128 Wide;

constexpr double kSmallestW = 1.0 / 16777216.0;
constexpr double kGuardPixels = 16384.0;

struct Vertex {
  glm::dvec4 clip{0.0};
  glm::dvec3 weights{0.0};
  std::int64_t x = 0, y = 0, z = 0;
};

struct Target {
  int width = 0, height = 0;
  Targets buffers;
  Outcomes* outcomes = nullptr;
};

Target make_target(const Targets& t, Outcomes* outcomes) {
  if (t.color) return {t.color->width(), t.color->height(), t, outcomes};
  if (t.depth) return {t.depth->width(), t.depth->height(), t, outcomes};
  return {t.stencil->width(), t.stencil->height(), t, outcomes};
}

void count(Outcome outcome, Outcomes& outcomes) {
  switch (outcome) {
    case Outcome::stencil_fail:
      ++outcomes.stencil_fail;
      return;
    case Outcome::depth_fail:
      ++outcomes.depth_fail;
      return;
    case Outcome::pass:
      ++outcomes.pass;
  }
}

bool inside(const std::optional<Rect>& rect, std::int64_t x, std::int64_t y) {
  return !rect || (x >= rect->x && y >= rect->y && x < std::int64_t{rect->x} + rect->width &&
                   y < std::int64_t{rect->y} + rect->height);
}

/// Distances to w, near, far, left, right, bottom, top, in the order in which they clip. With depth
/// clamp nothing lies outside near and far.
std::array<double, 7> distances(const glm::dvec4& p, const Rect& viewport, bool depth_clamp) {
  const double gx = 2.0 * kGuardPixels / viewport.width, gy = 2.0 * kGuardPixels / viewport.height;
  return {p.w - kSmallestW,
          depth_clamp ? 1.0 : p.w + p.z,
          depth_clamp ? 1.0 : p.w - p.z,
          gx * p.w + p.x,
          gx * p.w - p.x,
          gy * p.w + p.y,
          gy * p.w - p.y};
}

std::vector<Vertex> clip(const std::array<glm::vec4, 3>& triangle, const Rect& viewport,
                         bool depth_clamp) {
  std::vector<Vertex> polygon(3);
  for (int i = 0; i < 3; ++i) {
    polygon[static_cast<std::size_t>(i)].clip = glm::dvec4(triangle[static_cast<std::size_t>(i)]);
    polygon[static_cast<std::size_t>(i)].weights[i] = 1.0;
  }
  for (std::size_t plane = 0; plane < 7; ++plane) {
    std::vector<Vertex> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vertex& a = polygon[i];
      const Vertex& b = polygon[(i + 1) % polygon.size()];
      const double da = distances(a.clip, viewport, depth_clamp)[plane];
      const double db = distances(b.clip, viewport, depth_clamp)[plane];
      if (da >= 0.0) kept.push_back(a);
      if ((da >= 0.0) == (db >= 0.0)) continue;
      const Vertex& in = da >= 0.0 ? a : b;
      const Vertex& out = da >= 0.0 ? b : a;
      const double d_in = da >= 0.0 ? da : db, d_out = da >= 0.0 ? db : da;
      const double t = d_in / (d_in - d_out);
      Vertex crossing;
      crossing.clip = in.clip + (out.clip - in.clip) * t;
      crossing.clip.w = std::max(crossing.clip.w, kSmallestW);
      crossing.weights = in.weights + (out.weights - in.weights) * t;
      kept.push_back(crossing);
    }
    polygon = kept;
  }
  return polygon;
}

int fraction_bits(DepthFormat format) { return format == DepthFormat::d24 ? 8 : 16; }
std::int64_t depth_one(DepthFormat format) {
  return format == DepthFormat::d24 ? 0xffffff : 0xffff;
}

std::int64_t nearest_even(double v) { return static_cast<std::int64_t>(std::nearbyint(v)); }

void project(Vertex& v, const Rect& viewport, const State& state, DepthFormat format) {
  const double half_w = viewport.width * 0.5, half_h = viewport.height * 0.5;
  const double near = state.depth_range.near, far = state.depth_range.far;
  const double x = (v.clip.x / v.clip.w) * half_w + (viewport.x + half_w);
  const double y = (v.clip.y / v.clip.w) * half_h + (viewport.y + half_h);
  const double z = (v.clip.z / v.clip.w) * ((far - near) * 0.5) + (far + near) * 0.5;
  const double limit_xy = 16777216.0, limit_z = 1152921504606846976.0;
  v.x = nearest_even(std::clamp(x * 256.0, -limit_xy, limit_xy));
  v.y = nearest_even(std::clamp(y * 256.0, -limit_xy, limit_xy));
  const double one = static_cast<double>(depth_one(format) << fraction_bits(format));
  const double scaled = z * one;
  v.z = nearest_even(state.depth_clamp ? std::clamp(scaled, -limit_z, limit_z)
                                       : std::clamp(scaled, 0.0, one));
}

Wide floor_quotient(Wide a, Wide b) {
  Wide q = a / b;
  if (q * b > a) --q;
  return q;
}
Wide half_up_quotient(Wide a, Wide b) { return floor_quotient(2 * a + b, 2 * b); }

/// Twice the signed area of (a, b, (x, y)) in 1/65536 square pixels.
std::int64_t edge(const Vertex& a, const Vertex& b, std::int64_t x, std::int64_t y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// A pixel centre on an edge belongs to the triangle if the edge is a left or a bottom one
/// (counter-clockwise, y upwards).
bool on_inner_side(const Vertex& a, const Vertex& b, std::int64_t x, std::int64_t y) {
  const std::int64_t e = edge(a, b, x, y);
  const bool left = b.y < a.y, bottom = b.y == a.y && b.x > a.x;
  return e > 0 || (e == 0 && (left || bottom));
}

/// The depth of docs/semantics.md: a plane re-based exactly at each 64x64 tile.
class Plane {
 public:
  Plane(const std::array<Vertex, 3>& v, std::int64_t area, const State& state, DepthFormat format)
      : v0_(v[0]), area_(area), bits_(fraction_bits(format)) {
    const Wide dx1 = v[1].x - v[0].x, dy1 = v[1].y - v[0].y, dz1 = v[1].z - v[0].z;
    const Wide dx2 = v[2].x - v[0].x, dy2 = v[2].y - v[0].y, dz2 = v[2].z - v[0].z;
    rise_x_ = dz1 * dy2 - dz2 * dy1;
    rise_y_ = dx1 * dz2 - dx2 * dz1;
    slope_x_ = half_up_quotient(rise_x_ * 256, area_);
    slope_y_ = half_up_quotient(rise_y_ * 256, area_);
    if (state.polygon_offset) offset_ = offset(*state.polygon_offset);
    low_ = 0;
    high_ = depth_one(format);
    if (state.depth_clamp) {
      const double near = state.depth_range.near, far = state.depth_range.far;
      low_ = nearest_even(std::min(near, far) * static_cast<double>(depth_one(format)));
      high_ = nearest_even(std::max(near, far) * static_cast<double>(depth_one(format)));
    }
  }

  std::uint32_t at(int x, int y) const {
    const int tile_x = x / 64 * 64, tile_y = y / 64 * 64;
    const Wide dx = Wide{tile_x} * 256 + 128 - v0_.x, dy = Wide{tile_y} * 256 + 128 - v0_.y;
    const Wide base = half_up_quotient(rise_x_ * dx + rise_y_ * dy, area_) + v0_.z + offset_;
    const Wide value = base + slope_x_ * (x - tile_x) + slope_y_ * (y - tile_y);
    const Wide depth = floor_quotient(value + (Wide{1} << (bits_ - 1)), Wide{1} << bits_);
    return static_cast<std::uint32_t>(std::clamp<Wide>(depth, low_, high_));
  }

 private:
  Wide offset(const PolygonOffset& o) const {
    const auto size = [](Wide v) { return v < 0 ? -v : v; };
    const double slope = static_cast<double>(std::max(size(rise_x_), size(rise_y_))) * 256.0 /
                         static_cast<double>(area_);
    const double value = static_cast<double>(o.factor) * slope +
                         static_cast<double>(o.units) * static_cast<double>(1 << bits_);
    const double limit = 1152921504606846976.0;
    return std::isnan(value) ? 0 : nearest_even(std::clamp(value, -limit, limit));
  }

  Vertex v0_;
  Wide area_, rise_x_, rise_y_, slope_x_, slope_y_, offset_ = 0, low_, high_;
  int bits_;
};

/// Perspective-correct weights of the mesh triangle's vertices at a pixel centre, in the written
/// order of operations.
glm::vec3 weights_at(const std::array<Vertex, 3>& v, std::int64_t area, std::int64_t cx,
                     std::int64_t cy) {
  const std::array<double, 3> share{static_cast<double>(edge(v[1], v[2], cx, cy)),
                                    static_cast<double>(edge(v[2], v[0], cx, cy)),
                                    static_cast<double>(edge(v[0], v[1], cx, cy))};
  std::array<double, 3> q{};
  for (std::size_t i = 0; i < 3; ++i)
    q[i] = share[i] * ((1.0 / v[i].clip.w) / static_cast<double>(area));
  const double inverse = 1.0 / ((q[0] + q[1]) + q[2]);
  return glm::vec3((v[0].weights * (q[0] * inverse) + v[1].weights * (q[1] * inverse)) +
                   v[2].weights * (q[2] * inverse));
}

void draw_triangle(const Draw& draw, const Target& target, std::array<Vertex, 3> v,
                   std::size_t first_index) {
  const State& state = draw.state;
  std::int64_t area = edge(v[0], v[1], v[2].x, v[2].y);
  if (area == 0) return;
  const bool front = (area > 0) == (state.front_face == FrontFace::ccw);
  if (state.cull == Cull::front_and_back || (state.cull == Cull::front && front) ||
      (state.cull == Cull::back && !front))
    return;
  if (area < 0) {
    std::swap(v[1], v[2]);
    area = -area;
  }
  const DepthFormat format =
      target.buffers.depth ? target.buffers.depth->format() : DepthFormat::d24;
  const Plane plane(v, area, state, format);
  for (int y = 0; y < target.height; ++y)
    for (int x = 0; x < target.width; ++x) {
      const std::int64_t cx = x * 256 + 128, cy = y * 256 + 128;
      if (!inside(state.scissor, x, y) || !inside(state.viewport, x, y)) continue;
      if (!on_inner_side(v[0], v[1], cx, cy) || !on_inner_side(v[1], v[2], cx, cy) ||
          !on_inner_side(v[2], v[0], cx, cy))
        continue;
      const auto color = [&] {
        return shade(draw.shading, interpolate(draw, draw.mesh.indices.data() + first_index,
                                               weights_at(v, area, cx, cy), front));
      };
      count(process_fragment(draw, target.buffers, {x, y, plane.at(x, y), front}, color),
            *target.outcomes);
    }
}

glm::vec4 transform(const glm::mat4& m, const glm::vec4& p) {
  glm::vec4 out;
  for (int row = 0; row < 4; ++row)
    out[row] = ((m[0][row] * p.x + m[1][row] * p.y) + m[2][row] * p.z) + m[3][row] * p.w;
  return out;
}

/// Turns the polygon so that it starts at the vertex with the least (x, y, depth).
void start_at_lowest(std::vector<Vertex>& polygon) {
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < polygon.size(); ++i) {
    const Vertex &a = polygon[i], &b = polygon[lowest];
    const bool lower = a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    if (lower) lowest = i;
  }
  std::rotate(polygon.begin(), polygon.begin() + static_cast<std::ptrdiff_t>(lowest),
              polygon.end());
}

void run(const Draw& draw, const Target& target) {
  const Rect viewport = draw.state.viewport.value_or(Rect{0, 0, target.width, target.height});
  const DepthFormat format =
      target.buffers.depth ? target.buffers.depth->format() : DepthFormat::d24;
  for (std::size_t i = 0; i < draw.mesh.indices.size(); i += 3) {
    std::array<glm::vec4, 3> p;
    bool finite = true;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = transform(draw.clip_from_model, draw.mesh.positions[draw.mesh.indices[i + k]]);
      for (int c = 0; c < 4; ++c) finite = finite && std::isfinite(p[k][c]);
    }
    if (!finite) continue;
    std::vector<Vertex> polygon = clip(p, viewport, draw.state.depth_clamp);
    for (Vertex& v : polygon) project(v, viewport, draw.state, format);
    if (polygon.size() > 3) start_at_lowest(polygon);
    for (std::size_t k = 2; k < polygon.size(); ++k)
      draw_triangle(draw, target, {polygon[0], polygon[k - 1], polygon[k]}, i);
  }
}

void run(const Clear& clear, const Target& target) {
  for (int y = 0; y < target.height; ++y)
    for (int x = 0; x < target.width; ++x)
      if (inside(clear.scissor, x, y)) clear_pixel(clear, target.buffers, x, y);
}

void run(const Blit& blit, const Target& target) {
  for (int y = 0; y < target.height; ++y)
    for (int x = 0; x < target.width; ++x) {
      const std::int64_t u = std::int64_t{x} - blit.x, v = std::int64_t{y} - blit.y;
      if (u < 0 || v < 0 || u >= blit.image.width || v >= blit.image.height) continue;
      if (inside(blit.scissor, x, y))
        blit_pixel(blit, target.buffers, x, y,
                   blit.image.pixel(static_cast<int>(u), static_cast<int>(v)));
    }
}

}  // namespace

Outcomes execute(const Frame& frame, std::size_t commands) {
  Outcomes outcomes;
  for (const Pass& pass : frame.passes())
    for (const Command& command : pass.commands) {
      if (commands-- == 0) return outcomes;
      const Target target = make_target(pass.targets, &outcomes);
      std::visit([&](const auto& c) { run(c, target); }, command);
    }
  return outcomes;
}

}  // namespace gnomon::reference
