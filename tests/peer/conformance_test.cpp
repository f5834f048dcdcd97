// Stencil, depth tests and coverage against a real OpenGL (oracle: Mesa's llvmpipe) on input that
// both represent exactly: vertices on the 1/256 pixel grid, depths that are constant on a triangle
// or planes with whole slopes. Nothing is left to rounding, so every byte must agree. What reaches
// outside the target Mesa clips in float32, and a clipped vertex is off the grid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "explain.h"
#include "random_frames.h"
#include "raster/execute.h"
#include "replay.h"

using namespace gnomon;
using namespace gnomon::raster;

namespace {

/// A power of two: window coordinates of the grid are then exact in float32, whatever the order of
/// operations of a viewport transform is.
constexpr int kSize = 256;
constexpr int kFrames = 150, kDrawsAFrame = 4, kTrianglesADraw = 10;

struct GridMesh {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;
};

struct GridOptions {
  /// Vertices reach this far outside the target.
  int margin_px = 0;
  /// Slopes and polygon offset too. Without them depths lie on a few levels, far apart.
  bool depth_varies = true;
};

/// In 1/256 pixel. Coarser grids bring edges through pixel centres and shared edges.
int random_coordinate(random_frames::Random& random, int grid_fx, int margin_px) {
  const int margin = margin_px * 256 / grid_fx;
  return grid_fx * random.integer(-margin, kSize * 256 / grid_fx + margin);
}

/// Clip coordinates of a window position and of a depth in 2^-24; w is a power of two, so the
/// division is exact.
glm::vec4 clip_position(int x_fx, int y_fx, int depth, float w) {
  constexpr float kHalf = kSize * 128.0f;
  return glm::vec4(static_cast<float>(x_fx) / kHalf - 1.0f, static_cast<float>(y_fx) / kHalf - 1.0f,
                   static_cast<float>(depth) / 8388608.0f - 1.0f, 1.0f) *
         w;
}

/// A depth in 2^-24 that is far from half way between two integers of the depth buffer, so that it
/// converts to one value whether a driver multiplies in float32 or exactly: m 2^-24 (2^24 - 1) is m
/// - m 2^-24, close below m for small m and close above m - 1 for large m.
int random_depth(random_frames::Random& random) {
  const int step = 1 << 18;
  const int level = random.integer(0, 15);
  return level < 8 ? level * step : 16777216 - (15 - level) * step;
}

void add_vertex(random_frames::Random& random, GridMesh& mesh, int x_fx, int y_fx, int depth) {
  const float w = static_cast<float>(1 << random.integer(0, 3));
  mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
  mesh.positions.push_back(clip_position(x_fx, y_fx, depth, w));
}

void add_level_triangle(random_frames::Random& random, GridMesh& mesh, int margin_px) {
  constexpr int kGrids[] = {1, 1, 128, 256, 1024};
  const int grid = kGrids[random.integer(0, 4)];
  const int depth = random_depth(random);
  for (int i = 0; i < 3; ++i) {
    const int x = random_coordinate(random, grid, margin_px);
    const int y = random_coordinate(random, grid, margin_px);
    add_vertex(random, mesh, x, y, depth);
  }
}

/// A right triangle with legs of 2^k pixels from one pixel centre to others and whole slopes a
/// pixel: area, its inverse, slopes and all depths at pixel centres are exact in float32.
/// Depths stay below a quarter: from there on Mesa's float32 product with 2^24 - 1 is rounded to
/// halves before it is rounded to an integer.
void add_sloped_triangle(random_frames::Random& random, GridMesh& mesh) {
  const int leg = 1 << random.integer(1, 6);
  const int x = random.integer(leg, kSize - 1 - leg), y = random.integer(leg, kSize - 1 - leg);
  const int leg_x = random.chance(0.5f) ? leg : -leg, leg_y = random.chance(0.5f) ? leg : -leg;
  const int slope_x = random.integer(-4096, 4096), slope_y = random.integer(-4096, 4096);
  const int depth = random.integer(1 << 20, 1 << 21);
  const auto center = [](int pixel) { return 256 * pixel + 128; };
  add_vertex(random, mesh, center(x), center(y), depth);
  add_vertex(random, mesh, center(x + leg_x), center(y), depth + leg_x * slope_x);
  add_vertex(random, mesh, center(x), center(y + leg_y), depth + leg_y * slope_y);
}

/// A frame of grid-aligned draws in random states, a pass a draw. Of polygon offset whole units
/// only; viewport, depth range and blending are left at their defaults.
Frame grid_frame(std::uint32_t seed, random_frames::Targets& targets,
                 const GridOptions& options = {}) {
  random_frames::Random random(seed);
  Frame frame;
  frame.begin_pass("clear", targets.all());
  frame.clear({.color = glm::vec4(0.0f),
               .depth = static_cast<float>(random.integer(0, 4)) / 4.0f,
               .stencil = random.integer(0, 255)});
  for (int d = 0; d < kDrawsAFrame; ++d) {
    auto mesh = std::make_shared<GridMesh>();
    for (int t = 0; t < kTrianglesADraw; ++t) {
      if (!options.depth_varies || random.chance(0.7f))
        add_level_triangle(random, *mesh, options.margin_px);
      else
        add_sloped_triangle(random, *mesh);
    }
    frame.keep(mesh);
    Draw draw;
    draw.state = random_frames::random_state(random, kSize, kSize);
    if (!options.depth_varies) draw.state.polygon_offset.reset();
    if (draw.state.polygon_offset)
      draw.state.polygon_offset = PolygonOffset{0.0f, static_cast<float>(random.integer(-99, 99))};
    draw.state.viewport.reset();
    draw.state.depth_range = {};
    draw.state.color.blend.reset();
    draw.mesh = {.positions = mesh->positions, .indices = mesh->indices};
    const int ref = random.integer(-2, 260);
    draw.stencil_ref = {ref, 257 - ref};
    draw.shading = Flat{glm::vec4(static_cast<float>(random.integer(0, 255)) / 255.0f)};
    frame.begin_pass("draw", targets.all());
    frame.draw(std::move(draw));
  }
  return frame;
}

peer::Buffers own(const random_frames::Targets& targets) {
  return {targets.stencil.to_rows(), targets.depth.to_rows(), targets.color.to_rgba8_rows()};
}

template <class T>
std::size_t differing(const std::vector<T>& a, const std::vector<T>& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

}  // namespace

TEST(Conformance, GridAlignedTrianglesInRandomStatesLeaveEveryByteAsOpenGLDoes) {
  const peer::OsmesaContext context(kSize, kSize);
  std::size_t stencil = 0, depth = 0, color = 0, pixels = 0;
  for (std::uint32_t seed = 0; seed < kFrames; ++seed) {
    random_frames::Targets targets(kSize, kSize, ColorFormat::rgba8, DepthFormat::d24);
    const Frame frame = grid_frame(seed, targets);
    execute(frame, {.threads = 1});
    for (const Pass& pass : frame.passes()) peer::replay(context, pass, &targets.color);
    const peer::Buffers ours = own(targets), theirs = peer::read_back(context);
    stencil += differing(ours.stencil, theirs.stencil);
    depth += differing(ours.depth, theirs.depth);
    color += differing(ours.color, theirs.color);
    pixels += ours.stencil.size();
  }
  std::printf(
      "%s: %d triangles on the grid, %zu pixels: %zu stencil bytes, %zu depths, %zu colour "
      "bytes differ\n",
      context.renderer().c_str(), kFrames * kDrawsAFrame * kTrianglesADraw, pixels, stencil, depth,
      color);
  if (!context.is_llvmpipe()) GTEST_SKIP() << "the counts of this driver are for information";
  EXPECT_EQ(stencil, 0u);
  EXPECT_EQ(depth, 0u);
  EXPECT_EQ(color, 0u);
}

TEST(Conformance, TrianglesThatReachOutsideDifferOnlyAtEdgesThatOpenGLHasCut) {
  const peer::OsmesaContext context(kSize, kSize);
  peer::StencilCauses all;
  for (std::uint32_t seed = 0; seed < kFrames; ++seed) {
    random_frames::Targets targets(kSize, kSize, ColorFormat::rgba8, DepthFormat::d24);
    const Frame frame = grid_frame(seed, targets, {.margin_px = 16, .depth_varies = false});
    peer::Buffers before = own(targets), before_gl = before;
    for (std::size_t i = 0; i < frame.passes().size(); ++i) {
      execute(frame, {.threads = 1, .first_command = i, .commands = i + 1});
      peer::replay(context, frame.passes()[i], &targets.color);
      peer::Buffers after = own(targets), after_gl = peer::read_back(context);
      const peer::StencilCauses causes = peer::explain_stencil(
          frame.passes()[i], {before, before_gl, after, after_gl, kSize, kSize});
      all.differing += causes.differing;
      all.coverage += causes.coverage;
      all.earlier += causes.earlier;
      all.farthest_edge_px = std::max(all.farthest_edge_px, causes.farthest_edge_px);
      before = std::move(after);
      before_gl = std::move(after_gl);
    }
  }
  std::printf(
      "%s: %d triangles that reach outside: %zu stencil bytes differ, %zu at an edge (at "
      "most %.4f px away), %zu by an earlier draw\n",
      context.renderer().c_str(), kFrames * kDrawsAFrame * kTrianglesADraw, all.differing,
      all.coverage, all.farthest_edge_px, all.earlier);
  if (!context.is_llvmpipe()) GTEST_SKIP() << "the counts of this driver are for information";
  EXPECT_EQ(all.differing, all.coverage + all.earlier);
}
