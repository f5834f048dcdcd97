// Stencil, depth tests and coverage against a real OpenGL (oracle: Mesa's llvmpipe) on input that
// both represent exactly: vertices on the 1/256 pixel grid, depths that are constant on a triangle
// or planes with dyadic slopes. Nothing is left to rounding, so every stencil byte must agree.
#include <gtest/gtest.h>

#include <cstdio>

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

/// In 1/256 pixel, inside the target: what reaches outside, Mesa clips in float32, and a clipped
/// vertex is off the grid. Coarser grids bring edges through pixel centres and shared edges.
int random_coordinate(random_frames::Random& random, int grid_fx) {
  return grid_fx * random.integer(0, kSize * 256 / grid_fx);
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

void add_level_triangle(random_frames::Random& random, GridMesh& mesh) {
  constexpr int kGrids[] = {1, 1, 128, 256, 1024};
  const int grid = kGrids[random.integer(0, 4)];
  const int depth = random_depth(random);
  for (int i = 0; i < 3; ++i) {
    const int x = random_coordinate(random, grid), y = random_coordinate(random, grid);
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

/// A frame of grid-aligned draws in random states; polygon offset, viewport and depth
/// range aside (their floats are Mesa's own), whatever a state can have.
Frame grid_frame(std::uint32_t seed, random_frames::Targets& targets) {
  random_frames::Random random(seed);
  Frame frame;
  frame.begin_pass("grid", targets.all());
  frame.clear({.color = glm::vec4(0.0f),
               .depth = static_cast<float>(random.integer(0, 4)) / 4.0f,
               .stencil = random.integer(0, 255)});
  for (int d = 0; d < kDrawsAFrame; ++d) {
    auto mesh = std::make_shared<GridMesh>();
    for (int t = 0; t < kTrianglesADraw; ++t) {
      if (random.chance(0.7f))
        add_level_triangle(random, *mesh);
      else
        add_sloped_triangle(random, *mesh);
    }
    frame.keep(mesh);
    Draw draw;
    draw.state = random_frames::random_state(random, kSize, kSize);
    draw.state.polygon_offset.reset();
    draw.state.viewport.reset();
    draw.state.depth_range = {};
    draw.state.color.blend.reset();
    draw.mesh = {.positions = mesh->positions, .indices = mesh->indices};
    draw.stencil_ref = random.integer(-2, 260);
    draw.shading = Flat{glm::vec4(static_cast<float>(random.integer(0, 255)) / 255.0f)};
    frame.draw(std::move(draw));
  }
  return frame;
}

struct Differences {
  std::size_t stencil = 0, depth = 0, color = 0, pixels = 0;
};

Differences compare(const random_frames::Targets& targets, const peer::Buffers& gl) {
  Differences out;
  const std::vector<std::uint8_t> stencil = targets.stencil.to_rows();
  const std::vector<std::uint32_t> depth = targets.depth.to_rows();
  const std::vector<std::uint8_t> color = targets.color.to_rgba8_rows();
  for (std::size_t i = 0; i < stencil.size(); ++i) {
    out.stencil += stencil[i] != gl.stencil[i];
    out.depth += depth[i] != gl.depth[i];
    out.color += !std::equal(&color[4 * i], &color[4 * i] + 4, &gl.color[4 * i]);
  }
  out.pixels = stencil.size();
  return out;
}

}  // namespace

TEST(Conformance, GridAlignedTrianglesInRandomStatesLeaveEveryByteAsOpenGLDoes) {
  const peer::OsmesaContext context(kSize, kSize);
  Differences all;
  int differing_frames = 0;
  for (int i = 0; i < kFrames; ++i) {
    random_frames::Targets targets(kSize, kSize, ColorFormat::rgba8, DepthFormat::d24);
    const Frame frame = grid_frame(static_cast<std::uint32_t>(i), targets);
    execute(frame, {.threads = 1});
    peer::replay(context, frame.passes()[0], &targets.color);
    const Differences d = compare(targets, peer::read_back(context));
    all.stencil += d.stencil;
    all.depth += d.depth;
    all.color += d.color;
    all.pixels += d.pixels;
    if (d.stencil != 0 && differing_frames++ < 3)
      std::printf("frame %d: %zu stencil bytes, %zu depths, %zu colours\n", i, d.stencil, d.depth,
                  d.color);
  }
  std::printf(
      "%s: %d triangles on the grid, %zu pixels: %zu stencil bytes, %zu depths, %zu colours"
      " differ\n",
      context.renderer().c_str(), kFrames * kDrawsAFrame * kTrianglesADraw, all.pixels, all.stencil,
      all.depth, all.color);
  if (!context.is_llvmpipe()) GTEST_SKIP() << "counts are for information with this driver";
  EXPECT_EQ(all.stencil, 0u);
  EXPECT_EQ(all.depth, 0u);
  EXPECT_EQ(all.color, 0u);
}
