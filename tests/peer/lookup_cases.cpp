#include <cmath>

#include "cases.h"
#include "random_frames.h"

namespace gnomon::peer {

using namespace gnomon::raster;
using random_frames::Random;

namespace {

constexpr int kDraws = 24;

/// Texels are the depths of 16ths.
DepthMap random_map(Random& random) {
  DepthMap map{.width = 1 << random.integer(0, 4), .height = 1 << random.integer(0, 4)};
  for (int i = 0; i < map.width * map.height; ++i)
    map.depths.push_back(static_cast<float>(random.integer(0, 16)) / 16.0f);
  return map;
}

/// References are odd 32ths, so that no rounding brings one to a texel's side; or both ends of the
/// range and beyond, where reference and texel can be equal.
float random_reference(Random& random) {
  if (random.chance(0.3f)) return static_cast<float>(random.integer(-1, 3)) * 0.5f;
  return static_cast<float>(2 * random.integer(0, 15) + 1) / 32.0f;
}

/// Texel coordinates are eighths at every pixel centre, the reference rises by no more than 1/64
/// over the target, and q is a power of two: all of it is exact in float32, also as a plane over a
/// right triangle whose legs are powers of two.
glm::mat4 random_map_from_position(Random& random, const DepthMap& map) {
  constexpr float kHalf = kCaseSize / 2.0f;
  const auto eighths = [&](int reach) {
    return static_cast<float>(random.integer(-reach, reach)) / 8.0f;
  };
  const float q = std::ldexp(1.0f, random.integer(-2, 2));
  glm::mat4 m(0.0f);
  const auto set_row = [&](int row, float at_middle, float step_x, float step_y) {
    m[0][row] = step_x * kHalf * q;
    m[1][row] = step_y * kHalf * q;
    m[3][row] = at_middle * q;
  };
  const auto width = static_cast<float>(map.width), height = static_cast<float>(map.height);
  const float s_x = eighths(4), s_y = eighths(2), t_x = eighths(2), t_y = eighths(4);
  const float u = eighths(8 * map.width) + 0.5f * width;
  const float v = eighths(8 * map.height) + 0.5f * height;
  set_row(0, u / width, s_x / width, s_y / width);
  set_row(1, v / height, t_x / height, t_y / height);
  const float reference = random_reference(random);
  const bool varies = std::fmod(reference, 0.5f) != 0.0f;
  const auto slope = [&] {
    return varies ? std::ldexp(static_cast<float>(random.integer(-1, 1)), -13) : 0.0f;
  };
  const float r_x = slope();
  set_row(2, reference, r_x, slope());
  m[3][3] = q;
  return m;
}

/// Two right triangles with legs of 2^k pixels between corners of pixels: a rectangle, which every
/// fill rule covers once.
void add_rectangle(Random& random, std::vector<Triangle>& triangles) {
  const int width = 1 << random.integer(2, 5), height = 1 << random.integer(2, 5);
  const int x = random.integer(0, kCaseSize - width), y = random.integer(0, kCaseSize - height);
  const auto vertex = [](int x_px, int y_px) {
    constexpr float kHalf = kCaseSize / 2.0f;
    return glm::vec4(static_cast<float>(x_px) / kHalf - 1.0f,
                     static_cast<float>(y_px) / kHalf - 1.0f, 0.0f, 1.0f);
  };
  const glm::vec4 right_bottom = vertex(x + width, y), left_top = vertex(x, y + height);
  triangles.push_back({vertex(x, y), right_bottom, left_top});
  triangles.push_back({vertex(x + width, y + height), left_top, right_bottom});
}

CaseDraw random_draw(Random& random, const DepthMap& map) {
  CaseDraw draw;
  // With 0 and 1 a colour is the look-up's own share.
  for (int c = 0; c < 4; ++c) draw.color[c] = static_cast<float>(random.integer(0, 3) > 0);
  DepthLookup lookup;
  lookup.map_from_position = random_map_from_position(random, map);
  lookup.func = static_cast<CompareFunc>(random.integer(0, 7));
  lookup.filter = random.chance(0.5f) ? Filter::linear : Filter::nearest;
  lookup.border.reset();
  if (random.chance(0.5f)) lookup.border = static_cast<float>(random.integer(0, 2)) * 0.5f;
  draw.lookup = lookup;
  draw.depth_texture_mode = static_cast<DepthTextureMode>(random.integer(0, 2));
  for (int count = random.integer(1, 3); count > 0; --count) add_rectangle(random, draw.triangles);
  return draw;
}

}  // namespace

Case lookup_case(std::uint32_t seed) {
  Random random(seed);
  Case out{.width = kCaseSize, .height = kCaseSize, .map = random_map(random)};
  out.commands.emplace_back(Clear{.color = glm::vec4(0.0f)});
  for (int d = 0; d < kDraws; ++d) out.commands.emplace_back(random_draw(random, out.map));
  return out;
}

}  // namespace gnomon::peer
