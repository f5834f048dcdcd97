#include <algorithm>
#include <cmath>

#include "cases.h"
#include "random_frames.h"

namespace gnomon::peer {

using namespace gnomon::raster;
using random_frames::Random;

namespace {

constexpr int kStates = 3, kDraws = 200;

/// A depth of m 2^-24 is m - m 2^-24 integers of the depth buffer. One that is far from half way
/// between two integers becomes the same one whether a driver rounds the product to float32 first
/// or not.
bool converts_alike(float depth) { return depth <= 0.2f || depth >= 0.8f; }

/// A multiple of 1/16 in [0, 1].
float random_sixteenth(Random& random) {
  for (;;) {
    const float depth = static_cast<float>(random.integer(0, 16)) / 16.0f;
    if (converts_alike(depth)) return depth;
  }
}

bool trivial(BlendFactor factor) {
  return factor == BlendFactor::zero || factor == BlendFactor::one;
}

/// What a case's draws take turns with.
struct Palette {
  /// Channels are 0 or 1. All products of blending then are, so every factor may be used; with
  /// other colours only 0 and 1 as factors, because llvmpipe's product of two 8-bit channels is one
  /// off the rounded quotient for some of them.
  bool extreme_colors = false;
  std::vector<State> states;
};

glm::vec4 random_color(Random& random, const Palette& palette) {
  glm::vec4 color;
  for (int c = 0; c < 4; ++c)
    color[c] = palette.extreme_colors ? static_cast<float>(random.integer(0, 1))
                                      : static_cast<float>(random.integer(0, 255)) / 255.0f;
  return color;
}

/// Of polygon offset whole units, and whole slopes times whole factors.
State random_pipeline(Random& random, const Palette& palette) {
  State state = random_frames::random_state(random, kCaseSize, kCaseSize);
  if (std::optional<Blend>& blend = state.color.blend) {
    blend->constant = random_color(random, palette);
    for (BlendFactor* factor :
         {&blend->src_color, &blend->dst_color, &blend->src_alpha, &blend->dst_alpha})
      if (!palette.extreme_colors && !trivial(*factor))
        *factor = random.chance(0.5f) ? BlendFactor::zero : BlendFactor::one;
  }
  if (state.polygon_offset) {
    const float factor = static_cast<float>(random.integer(-3, 3));
    state.polygon_offset = PolygonOffset{factor, static_cast<float>(random.integer(-99, 99))};
  }
  return state;
}

Palette random_palette(Random& random) {
  Palette palette{.extreme_colors = random.chance(0.5f)};
  for (int i = 0; i < kStates; ++i) palette.states.push_back(random_pipeline(random, palette));
  return palette;
}

Rect random_scissor(Random& random) {
  const int x = random.integer(-5, kCaseSize - 8), y = random.integer(-5, kCaseSize - 8);
  return {x, y, random.integer(8, kCaseSize + 8), random.integer(8, kCaseSize + 8)};
}

/// Sides are powers of two, and the target holds at least a part of it.
Rect random_viewport(Random& random) {
  if (random.chance(0.6f)) return {0, 0, kCaseSize, kCaseSize};
  const int width = 1 << random.integer(4, 7), height = 1 << random.integer(4, 7);
  const int x = random.integer(8 - width, kCaseSize - 8);
  return {x, random.integer(8 - height, kCaseSize - 8), width, height};
}

/// Clip coordinates of a position in 1/256 pixel of the viewport and of a depth in [-1, 1]; w is a
/// power of two, so the division is exact.
glm::vec4 clip_position(Random& random, const Rect& viewport, int x_fx, int y_fx, float z) {
  const float x = static_cast<float>(x_fx) / static_cast<float>(viewport.width * 128) - 1.0f;
  const float y = static_cast<float>(y_fx) / static_cast<float>(viewport.height * 128) - 1.0f;
  return glm::vec4(x, y, z, 1.0f) * static_cast<float>(1 << random.integer(0, 3));
}

float window_depth(float z, const DepthRange& range) {
  return z * ((range.far - range.near) * 0.5f) + (range.far + range.near) * 0.5f;
}

/// With depth clamp also outside of the range.
float random_level(Random& random, const State& state) {
  const int reach = state.depth_clamp ? 24 : 16;
  for (;;) {
    const float z = static_cast<float>(random.integer(-reach, reach)) / 16.0f;
    if (converts_alike(window_depth(z, state.depth_range))) return z;
  }
}

/// Coarser grids bring edges through pixel centres and shared edges.
Triangle level_triangle(Random& random, const CaseDraw& draw) {
  constexpr int kGrids[] = {1, 1, 128, 256, 1024};
  const int grid = kGrids[random.integer(0, 4)];
  const Rect& viewport = *draw.state.viewport;
  const float z = random_level(random, draw.state);
  Triangle triangle;
  for (glm::vec4& position : triangle) {
    const int x_fx = grid * random.integer(0, viewport.width * 256 / grid);
    const int y_fx = grid * random.integer(0, viewport.height * 256 / grid);
    position = clip_position(random, viewport, x_fx, y_fx, z);
  }
  return triangle;
}

/// A right triangle with legs of 2^k pixels from one pixel centre to others and whole slopes a
/// pixel, in units of 2^-24: area, its inverse, slopes and all depths at pixel centres are exact in
/// float32. Depths stay below a quarter: from there on a float32 product with 2^24 - 1 is rounded
/// to halves before it is rounded to an integer.
Triangle sloped_triangle(Random& random) {
  const Rect whole{0, 0, kCaseSize, kCaseSize};
  const int leg = 1 << random.integer(1, 4);
  const int x = random.integer(leg, kCaseSize - 1 - leg);
  const int y = random.integer(leg, kCaseSize - 1 - leg);
  const int leg_x = random.chance(0.5f) ? leg : -leg, leg_y = random.chance(0.5f) ? leg : -leg;
  const int slope_x = random.integer(-4096, 4096), slope_y = random.integer(-4096, 4096);
  const int depth = random.integer(1 << 20, 1 << 21);
  const auto vertex = [&](int x_px, int y_px, int z) {
    return clip_position(random, whole, 256 * x_px + 128, 256 * y_px + 128,
                         static_cast<float>(z) / 8388608.0f - 1.0f);
  };
  const glm::vec4 corner = vertex(x, y, depth);
  const glm::vec4 along_x = vertex(x + leg_x, y, depth + leg_x * slope_x);
  return {corner, along_x, vertex(x, y + leg_y, depth + leg_y * slope_y)};
}

CaseDraw random_draw(Random& random, const Palette& palette) {
  CaseDraw draw;
  draw.state = palette.states[static_cast<std::size_t>(random.integer(0, kStates - 1))];
  draw.state.scissor.reset();
  if (random.chance(0.3f)) draw.state.scissor = random_scissor(random);
  const int ref = random.integer(-2, 260);
  draw.stencil_ref = {ref, 257 - ref};
  draw.color = random_color(random, palette);
  const bool sloped = random.chance(0.3f);
  draw.state.viewport = sloped ? Rect{0, 0, kCaseSize, kCaseSize} : random_viewport(random);
  draw.state.depth_range = {};
  if (!sloped && random.chance(0.5f)) {
    const float near = random_sixteenth(random);
    draw.state.depth_range = {near, random_sixteenth(random)};
  }
  for (int count = random.integer(1, 3); count > 0; --count)
    draw.triangles.push_back(sloped ? sloped_triangle(random) : level_triangle(random, draw));
  return draw;
}

/// Masked and scissored.
Clear random_clear(Random& random, const Palette& palette) {
  Clear clear;
  if (random.chance(0.5f)) clear.color = random_color(random, palette);
  if (random.chance(0.5f)) clear.depth = random_sixteenth(random);
  if (random.chance(0.5f)) clear.stencil = random.integer(-3, 300);
  for (bool& write : clear.color_write) write = random.chance(0.7f);
  clear.depth_write = random.chance(0.8f);
  clear.stencil_write_mask = static_cast<std::uint8_t>(random.integer(0, 255));
  if (random.chance(0.7f)) clear.scissor = random_scissor(random);
  return clear;
}

}  // namespace

Case grid_case(std::uint32_t seed) {
  Random random(seed);
  Case out{.width = kCaseSize, .height = kCaseSize};
  const Palette palette = random_palette(random);
  out.commands.emplace_back(Clear{.color = random_color(random, palette),
                                  .depth = random_sixteenth(random),
                                  .stencil = random.integer(0, 255)});
  for (int d = 0; d < kDraws; ++d) {
    if (random.chance(0.03f)) out.commands.emplace_back(random_clear(random, palette));
    out.commands.emplace_back(random_draw(random, palette));
  }
  return out;
}

}  // namespace gnomon::peer
