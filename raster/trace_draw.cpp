#include "raster/trace_draw.h"

#include <algorithm>
#include <optional>

#include "raster/blend.h"
#include "raster/compare_func.h"
#include "raster/interpolate.h"
#include "raster/kernels.h"
#include "raster/stencil_op.h"
#include "raster/unorm.h"
#include "raster/write_color.h"

namespace gnomon::raster {

namespace {

std::int64_t floor_quotient(std::int64_t a, std::int64_t b) {
  const std::int64_t q = a / b;
  return q - (q * b > a ? 1 : 0);
}

/// The pixels [first, end) of a row that a triangle covers.
struct Span {
  int first, end;
};

/// Each edge is a (x - x0) + b (y - y0) >= bias at x = 256 px + 128, which bounds px on one side.
Span covered_in_row(const SetupTriangle& triangle, int y, Span span) {
  for (int k = 0; k < 3; ++k) {
    const Edge edge = triangle.edge(k);
    const std::int64_t at_zero = edge.at(128, std::int64_t{y} * 256 + 128) - edge.bias();
    const std::int64_t step = std::int64_t{edge.a} * 256;
    if (step == 0) {
      if (at_zero < 0) return {0, 0};
    } else if (step > 0) {
      // px >= -at_zero / step, rounded up.
      span.first = static_cast<int>(
          std::clamp<std::int64_t>(-floor_quotient(at_zero, step), span.first, span.end));
    } else {
      span.end = static_cast<int>(
          std::clamp<std::int64_t>(floor_quotient(at_zero, -step) + 1, span.first, span.end));
    }
  }
  return span;
}

/// A triangle's depths in one tile.
class TileDepths {
 public:
  TileDepths(const SetupTriangle& triangle, const DrawSetup& setup, int tile_x, int tile_y)
      : triangle_(triangle),
        setup_(setup),
        x_(tile_x),
        y_(tile_y),
        bits_(depth_fraction_bits(setup.depth_format)),
        base_(depth_base_at(triangle.vertices, triangle.area(), tile_x, tile_y) +
              (std::uint64_t{1} << (bits_ - 1))) {}

  std::uint32_t at(int x, int y) const {
    const std::uint64_t value = base_ + static_cast<std::uint64_t>(x - x_) * triangle_.step_x +
                                static_cast<std::uint64_t>(y - y_) * triangle_.step_y;
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(
        static_cast<std::int64_t>(value) >> bits_, setup_.depth_low, setup_.depth_high));
  }

 private:
  const SetupTriangle& triangle_;
  const DrawSetup& setup_;
  int x_, y_, bits_;
  std::uint64_t base_;
};

}  // namespace

glm::vec4 stored_color(ColorFormat format, const ColorState& state, const glm::vec4& source,
                       const glm::vec4& stored) {
  if (format == ColorFormat::rgba32f) return blend_rgba32f(state, source, stored);
  const Rgba8 constant = to_rgba8(state.blend ? state.blend->constant : glm::vec4(0.0f));
  return to_floats(blend_rgba8(state, constant, to_rgba8(source), to_rgba8(stored)));
}

DrawTrace::DrawTrace(const Draw& draw, const Targets& targets)
    : draw_(draw),
      targets_(targets),
      setup_(make_draw_setup(draw, targets)),
      colors_{draw.mesh.colors, draw.mesh.colors},
      color_(targets.color && any(draw.state.color.write)) {
  const Kernels& fastest = kernels(Isa::best);
  geometry_.begin(setup_);
  geometry_.run_vertices(fastest, 0, geometry_.vertex_count());
  for (std::size_t chunk = 0; chunk < geometry_.chunk_count(); ++chunk)
    geometry_.run_chunk(fastest, chunk);
  if (color_ && lights_vertices(draw)) {
    lit_.begin(draw);
    lit_.run(fastest, 0, lit_.vertex_count());
    colors_ = lit_.colors();
  }
}

void DrawTrace::for_each_triangle(const std::function<void(const SetupTriangle&)>& visit) const {
  for (const TriangleChunk& chunk : geometry_.chunks())
    for (const SetupTriangle& triangle : chunk.set_up.triangles) visit(triangle);
}

void DrawTrace::for_each_fragment(const PixelBox& box,
                                  const std::function<void(const TracedFragment&)>& visit) const {
  for (const TriangleChunk& chunk : geometry_.chunks()) {
    const TriangleSource source = geometry_.source_of(chunk, colors_);
    for (const SetupTriangle& triangle : chunk.set_up.triangles) {
      const PixelBox inside = intersect(box, intersect(triangle.box(), setup_.box));
      if (inside.empty()) continue;
      for (int ty = inside.y0 / kTileSize * kTileSize; ty < inside.y1; ty += kTileSize)
        for (int tx = inside.x0 / kTileSize * kTileSize; tx < inside.x1; tx += kTileSize) {
          std::optional<TileDepths> depths;
          const int end_y = std::min(ty + kTileSize, inside.y1);
          for (int y = std::max(ty, inside.y0); y < end_y; ++y) {
            const Span span = covered_in_row(
                triangle, y, {std::max(tx, inside.x0), std::min(tx + kTileSize, inside.x1)});
            if (span.first < span.end && !depths) depths.emplace(triangle, setup_, tx, ty);
            for (int x = span.first; x < span.end; ++x)
              visit({&triangle, &source, x, y, depths->at(x, y)});
          }
        }
    }
  }
}

const StencilFace* DrawTrace::face(bool front_facing) const {
  if (!draw_.state.stencil || !targets_.stencil) return nullptr;
  return front_facing ? &draw_.state.stencil->front : &draw_.state.stencil->back;
}

StencilOp DrawTrace::stencil_op(bool front_facing, Outcome outcome) const {
  const StencilFace* const tests = face(front_facing);
  if (!tests) return StencilOp::keep;
  switch (outcome) {
    case Outcome::stencil_fail:
      return tests->fail;
    case Outcome::depth_fail:
      return tests->depth_fail;
    case Outcome::pass:
      return tests->pass;
  }
  return StencilOp::keep;
}

Outcome DrawTrace::test(const TracedFragment& fragment, PixelValues& pixel) const {
  const bool front = fragment.triangle->front_facing;
  const StencilFace* const stencil = face(front);
  const auto ref = static_cast<std::uint8_t>(
      std::clamp(front ? draw_.stencil_ref.front : draw_.stencil_ref.back, 0, 255));
  Outcome outcome = Outcome::pass;
  if (stencil &&
      !holds<int>(stencil->func, ref & stencil->read_mask, pixel.stencil & stencil->read_mask))
    outcome = Outcome::stencil_fail;
  else if (draw_.state.depth && targets_.depth) {
    if (!holds(draw_.state.depth->func, fragment.depth, pixel.depth))
      outcome = Outcome::depth_fail;
    else if (draw_.state.depth->write)
      pixel.depth = fragment.depth;
  }
  if (stencil)
    pixel.stencil =
        stencil_after(stencil_op(front, outcome), pixel.stencil, ref, stencil->write_mask);
  return outcome;
}

Outcome DrawTrace::apply(const TracedFragment& fragment, PixelValues& pixel) const {
  const Outcome outcome = test(fragment, pixel);
  if (outcome != Outcome::pass || !color_) return outcome;
  const glm::vec4 color =
      shade(draw_.shading,
            interpolate(draw_, *fragment.triangle, *fragment.source, fragment.x, fragment.y));
  pixel.color = stored_color(targets_.color->format(), draw_.state.color, color, pixel.color);
  return outcome;
}

}  // namespace gnomon::raster
