#include "depth_batches.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "random_frames.h"

namespace gnomon::depth_batches {

using namespace gnomon::raster;
using exact_depth::Piece;
using exact_depth::Plane;
using exact_depth::Span;
using exact_depth::View;
using random_frames::Random;

namespace {

/// Powers of two, so that clip coordinates of the 1/256 pixel grid are exact in float32.
struct Size {
  int width = 1024, height = 1024;
};

Size size_of(Kind kind) {
  if (kind == Kind::huge || kind == Kind::huge_perspective) return {8192, 128};
  return {};
}

double uniform(Random& random, double low, double high) {
  return low + (high - low) * (random.integer(0, 1 << 30) * 0x1p-30);
}

double log_uniform(Random& random, double low, double high) {
  return std::exp2(uniform(random, std::log2(low), std::log2(high)));
}

/// Window position in pixels.
struct Point {
  double x = 0.0, y = 0.0;
};

/// Window depths of three vertices in 2^-24: anywhere, or within 2^-24 to 2^-4 of each other.
std::array<int, 3> random_depths(Random& random) {
  constexpr int kOne = 1 << 24;
  if (random.chance(0.5f))
    return {random.integer(0, kOne), random.integer(0, kOne), random.integer(0, kOne)};
  const int spread = 1 << random.integer(0, 20), base = random.integer(0, kOne - spread);
  return {base + random.integer(0, spread), base + random.integer(0, spread),
          base + random.integer(0, spread)};
}

/// Clip coordinates that stand for a point of the 1/256 pixel grid and a depth in 2^-24 exactly, in
/// float32 too: w is a power of two from 2^-10 to 2^20.
glm::vec4 on_grid(const Point& p, int depth, const View& view, Random& random) {
  const double x = std::nearbyint(p.x * 256.0) / 256.0, y = std::nearbyint(p.y * 256.0) / 256.0;
  const double w = std::ldexp(1.0, random.integer(-10, 20));
  return glm::vec4(glm::dvec4(2.0 * x / view.width - 1.0, 2.0 * y / view.height - 1.0,
                              depth * 0x1p-23 - 1.0, 1.0) *
                   w);
}

/// Clip coordinates near normalized device coordinates times w: multiples of w's binade / 2^bits,
/// so that exact planes fit 128 bits.
glm::vec4 off_grid(double x, double y, double z, double w, int bits) {
  const double unit = std::ldexp(1.0, std::ilogb(w) - bits);
  const auto whole = [&](double v) { return static_cast<float>(std::nearbyint(v / unit) * unit); };
  return {whole(x * w), whole(y * w), whole(z * w), whole(w)};
}

/// Three points inside [1, size - 1] of a cell, of different sizes and shapes.
std::array<Point, 3> in_cell(Random& random, double x0, double y0, double width, double height) {
  std::array<Point, 3> p;
  for (Point& q : p)
    q = {x0 + uniform(random, 1.0, width - 1.0), y0 + uniform(random, 1.0, height - 1.0)};
  if (random.chance(0.5f)) return p;
  const double share = log_uniform(random, 1.0 / 256.0, 1.0);
  if (random.chance(0.5f)) {
    // Smaller by `share`.
    for (std::size_t i : {1, 2})
      p[i] = {p[0].x + (p[i].x - p[0].x) * share, p[0].y + (p[i].y - p[0].y) * share};
  } else {
    // Narrower by `share`: the third point moves towards the others' edge.
    const double t = uniform(random, 0.0, 1.0);
    const Point on_edge{p[0].x + (p[1].x - p[0].x) * t, p[0].y + (p[1].y - p[0].y) * t};
    p[2] = {on_edge.x + (p[2].x - on_edge.x) * share, on_edge.y + (p[2].y - on_edge.y) * share};
  }
  return p;
}

/// Calls body(left, bottom) for each cell of the target.
template <class Body>
void for_each_cell(const View& view, int width, int height, Body body) {
  for (int y = 0; y + height <= view.height; y += height)
    for (int x = 0; x + width <= view.width; x += width) body(x, y);
}

void add_on_grid(Batch& batch, const std::array<Point, 3>& points, Random& random) {
  const std::array<int, 3> depths = random_depths(random);
  for (std::size_t i = 0; i < 3; ++i)
    batch.positions.push_back(on_grid(points[i], depths[i], batch.view, random));
}

void add_off_grid(Batch& batch, const std::array<Point, 3>& points, double z_limit, double w_low,
                  double w_high, Random& random) {
  const bool near_each_other = random.chance(0.5f);
  const double z0 = uniform(random, -z_limit, z_limit);
  const double spread = near_each_other ? log_uniform(random, 1e-6, 0.1) : 2.0 * z_limit;
  for (const Point& p : points) {
    const double z = near_each_other ? z0 + uniform(random, -spread, spread)
                                     : uniform(random, -z_limit, z_limit);
    batch.positions.push_back(
        off_grid(2.0 * p.x / batch.view.width - 1.0, 2.0 * p.y / batch.view.height - 1.0,
                 std::clamp(z, -z_limit, z_limit), log_uniform(random, w_low, w_high), 24));
  }
}

/// Slivers side by side, 6 pixels apart, all leaning by the same slope.
void add_slivers(Batch& batch, Random& random) {
  const View& view = batch.view;
  const bool wide = random.chance(0.5f);
  const int length = wide ? view.width : view.height, across = wide ? view.height : view.width;
  const double slope = random.chance(0.2f) ? 0.0 : uniform(random, -0.4, 0.4);
  const double rise = slope * length;
  const auto point = [&](double along, double offset) {
    const double side = offset + slope * along;
    return wide ? Point{along, side} : Point{side, along};
  };
  for (double base = std::max(0.0, -rise); base + 6.0 <= across - std::max(0.0, rise);
       base += 6.0) {
    const double from = uniform(random, 0.0, length * 0.1);
    const double to = uniform(random, length * 0.9, length);
    const double a = base + uniform(random, 0.5, 1.5), b = base + uniform(random, 0.5, 1.5);
    const double share = random.chance(0.5f) ? uniform(random, 0.0, 1.0) : 0.0;
    const double width = log_uniform(random, 1.0 / 256.0, 4.0);
    add_on_grid(batch,
                {point(from, a), point(to, b),
                 point(from + (to - from) * share, a + (b - a) * share + width)},
                random);
  }
}

/// From the left end of the target to the right, inside a strip of 2 rows or thinner, across the
/// centres of a row.
std::array<Point, 3> across_target(Random& random, int y0, int width) {
  const double height = log_uniform(random, 1.0 / 256.0, 2.0);
  const double centers = y0 + random.integer(0, 1) + 0.5;
  const double bottom = std::clamp(centers - uniform(random, 0.0, height), static_cast<double>(y0),
                                   y0 + 2.0 - height);
  const auto y = [&] { return bottom + uniform(random, 0.0, height); };
  return {Point{uniform(random, 0.0, width * 0.05), y()},
          Point{uniform(random, width * 0.95, width), y()},
          Point{uniform(random, 0.0, width), y()}};
}

/// Vertices before and behind the eye and up to 40 half widths to a side; each draws in its own
/// cell.
void add_through_eye_plane(Batch& batch, Random& random) {
  for_each_cell(batch.view, 64, 64, [&](int x0, int y0) {
    const double x = 2.0 * (x0 + 32) / batch.view.width - 1.0;
    const double y = 2.0 * (y0 + 32) / batch.view.height - 1.0;
    const double reach = log_uniform(random, 0.1, 40.0);
    for (int i = 0; i < 3; ++i) {
      const double w = log_uniform(random, 1e-3, 1e3);
      const double dx = uniform(random, -reach, reach), dy = uniform(random, -reach, reach);
      glm::vec4 p = off_grid(x + dx, y + dy, uniform(random, -2.0, 2.0), w, 17);
      if (random.chance(0.25f)) p = -p;
      batch.positions.push_back(p);
    }
    batch.scissors.push_back({x0, y0, 64, 64});
  });
}

/// A row's pixels inside a scissor.
Span inside(const Span& span, const std::vector<Rect>& scissors, std::size_t triangle,
            const View& view) {
  if (scissors.empty()) return {span.first, std::min(span.end, view.width)};
  const Rect& rect = scissors[triangle];
  return {std::max(span.first, rect.x), std::min(span.end, rect.x + rect.width)};
}

Span rows_inside(const Span& span, const std::vector<Rect>& scissors, std::size_t triangle) {
  if (scissors.empty()) return span;
  const Rect& rect = scissors[triangle];
  return {std::max(span.first, rect.y), std::min(span.end, rect.y + rect.height)};
}

/// A later piece of the triangle covers the pixel as well: a thin piece has turned over in the
/// snap.
bool drawn_over(std::span<const Piece> later, int x, int y) {
  return std::any_of(later.begin(), later.end(), [&](const Piece& piece) {
    const Span span = piece.covered(y);
    return x >= span.first && x < span.end;
  });
}

}  // namespace

std::string_view name(Kind kind) {
  constexpr std::array<std::string_view, 8> kNames{"tiny",     "ordinary",    "sliver",
                                                   "huge",     "perspective", "huge perspective",
                                                   "near far", "eye plane"};
  return kNames.at(static_cast<std::size_t>(kind));
}

Batch make_batch(Kind kind, bool offset, std::uint32_t seed) {
  Random random(seed);
  Batch batch;
  View& view = batch.view;
  const Size size = size_of(kind);
  view.width = size.width;
  view.height = size.height;
  if (offset)
    view.offset = PolygonOffset{static_cast<float>(random.integer(-16, 16)) / 4.0f,
                                static_cast<float>(random.integer(-400, 400)) / 4.0f};
  const auto cells = [&](int width, int height, auto add) {
    for_each_cell(view, width, height, add);
  };
  switch (kind) {
    case Kind::tiny:
      cells(8, 8, [&](int x, int y) { add_on_grid(batch, in_cell(random, x, y, 8, 8), random); });
      break;
    case Kind::ordinary:
      cells(32, 32,
            [&](int x, int y) { add_on_grid(batch, in_cell(random, x, y, 32, 32), random); });
      break;
    case Kind::sliver:
      add_slivers(batch, random);
      break;
    case Kind::huge:
      cells(view.width, 2,
            [&](int, int y) { add_on_grid(batch, across_target(random, y, view.width), random); });
      break;
    case Kind::perspective:
      cells(32, 32, [&](int x, int y) {
        add_off_grid(batch, in_cell(random, x, y, 32, 32), 1.0, 1e-3, 1e6, random);
      });
      break;
    case Kind::huge_perspective:
      cells(view.width, 2, [&](int, int y) {
        add_off_grid(batch, across_target(random, y, view.width), 1.0, 1e-3, 1e6, random);
      });
      break;
    case Kind::near_far:
      cells(32, 32, [&](int x, int y) {
        add_off_grid(batch, in_cell(random, x, y, 32, 32), 3.0, 1e-3, 1e6, random);
      });
      break;
    case Kind::eye_plane:
      view.clamp = random.chance(0.5f);
      add_through_eye_plane(batch, random);
      break;
  }
  return batch;
}

void record(const Batch& batch, Frame& frame, const Targets& targets) {
  const View& view = batch.view;
  frame.begin_pass("triangles", targets);
  frame.clear({.depth = 1.0f, .stencil = 0});
  StencilFace count;
  count.pass = StencilOp::incr;
  State state{.depth = DepthState{CompareFunc::always, true},
              .stencil = StencilState::both(count),
              .color = ColorState::off(),
              .polygon_offset = view.offset,
              .depth_range = view.range,
              .depth_clamp = view.clamp};
  auto indices = std::make_shared<std::vector<std::uint32_t>>(batch.positions.size());
  std::iota(indices->begin(), indices->end(), 0u);
  frame.keep(indices);
  if (batch.scissors.empty()) {
    frame.draw({.state = state, .mesh = {.positions = batch.positions, .indices = *indices}});
    return;
  }
  const std::span<const glm::vec4> positions = batch.positions;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    state.scissor = batch.scissors[i];
    frame.draw({.state = state,
                .mesh = {.positions = positions.subspan(3 * i, 3),
                         .indices = std::span<const std::uint32_t>(*indices).first(3)}});
  }
}

Drawn draw(const Batch& batch, const ExecuteOptions& options) {
  DepthBuffer depth(batch.view.width, batch.view.height, batch.view.format);
  StencilBuffer stencil(batch.view.width, batch.view.height);
  Frame frame;
  record(batch, frame, {.depth = &depth, .stencil = &stencil});
  execute(frame, options);
  return {depth.to_rows(), stencil.to_rows()};
}

void Measured::add(const Measured& other) {
  triangles += other.triangles;
  visible += other.visible;
  snapped.add(other.snapped);
  unrounded.add(other.unrounded);
  coverage_differs += other.coverage_differs;
}

Measured measure(const Batch& batch, const Drawn& drawn, Planes planes) {
  const View& view = batch.view;
  Measured out;
  out.triangles = batch.size();
  std::uint64_t common = 0, covered = 0;
  for (std::size_t t = 0; t < batch.size(); ++t) {
    const std::vector<Piece> pieces = exact_depth::snapped_pieces(batch.triangle(t), view);
    const std::optional<Plane> unrounded =
        planes == Planes::both ? exact_depth::unrounded_plane(batch.triangle(t), view)
                               : std::nullopt;
    const std::uint64_t before = covered;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const std::span<const Piece> later = std::span(pieces).subspan(i + 1);
      const Plane& plane = pieces[i].plane();
      const Span rows = rows_inside(pieces[i].rows(), batch.scissors, t);
      for (int y = rows.first; y < rows.end; ++y) {
        const Span row = inside(pieces[i].covered(y), batch.scissors, t, view);
        for (int x = row.first; x < row.end; ++x) {
          if (drawn_over(later, x, y)) continue;
          ++covered;
          const std::size_t pixel =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
              static_cast<std::size_t>(x);
          if (drawn.stencil[pixel] == 0) continue;
          ++common;
          out.snapped.add(drawn.depth[pixel], plane.at(x, y), plane);
          if (unrounded) out.unrounded.add(drawn.depth[pixel], unrounded->at(x, y), *unrounded);
        }
      }
    }
    out.visible += covered != before;
  }
  const auto written = static_cast<std::uint64_t>(
      drawn.stencil.size() - std::count(drawn.stencil.begin(), drawn.stencil.end(), 0));
  out.coverage_differs = (covered - common) + (written - common);
  return out;
}

}  // namespace gnomon::depth_batches
