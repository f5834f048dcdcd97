// Shading by depth lookups, as whole draws: random maps (full of noise, or far but for a box) x
// functions x filters x borders x blends x colour masks x vertex colours x depth tests, flat and
// lit, RGBA8 and RGBA32F, triangles from less than a pixel to the whole target, some of them cut.
// Oracle: the slow reference.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>

#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

constexpr std::array<Size, 5> kMapSizes{{{1, 1}, {7, 5}, {64, 64}, {65, 9}, {130, 70}}};

template <class T, std::size_t kCount>
const T& any_of(Random& random, const std::array<T, kCount>& values) {
  return values[static_cast<std::size_t>(random.integer(0, static_cast<int>(kCount) - 1))];
}

/// Noise; or the farthest depth but for a box of nearer ones, which most pixels do not meet.
void fill_map(Random& random, DepthBuffer& map) {
  const int one = static_cast<int>(map.max_value());
  const bool noise = random.chance(0.3f);
  const int x0 = random.integer(0, map.width()), y0 = random.integer(0, map.height());
  const int x1 = x0 + map.width() / 4, y1 = y0 + map.height() / 4, near = random.integer(0, one);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      map.plane().at(x, y) =
          static_cast<std::uint32_t>(noise ? random.integer(0, one)
                                     : x >= x0 && y >= y0 && x <= x1 && y <= y1 ? near
                                                                                : one);
}

/// Clip-space position to (s, t, r, q): straight, or turned and in perspective.
glm::mat4 random_map_matrix(Random& random) {
  glm::mat4 m(0.5f);
  m[3] = {0.5f, 0.5f, 0.5f, 1.0f};
  if (random.chance(0.3f)) m[2][2] = -0.5f;
  if (random.chance(0.3f)) m[3][2] += random.real(-0.4f, 0.1f);
  if (random.chance(0.2f)) return m;
  const float most = random.chance(0.1f) ? 2.0f : 0.2f;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m[c][r] += random.real(-most, most);
  return m;
}

DepthLookup random_lookup(Random& random, const DepthBuffer& map) {
  DepthLookup lookup{.map = &map, .map_from_position = random_map_matrix(random)};
  lookup.func = random.chance(0.5f) ? CompareFunc::greater : any_of(random, kFuncs);
  lookup.filter = random.chance(0.7f) ? Filter::nearest : Filter::linear;
  if (random.chance(0.3f)) lookup.border.reset();
  if (random.chance(0.2f)) lookup.border = random.real(-0.5f, 1.5f);
  if (random.chance(0.05f)) lookup.border = std::nanf("");
  return lookup;
}

/// A channel that blending adds or takes away; `wild` ones have no place in [0, 1].
float random_channel(Random& random, bool wild) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (!wild || random.chance(0.7f)) return random.real(0.0f, 0.3f);
  return any_of(random,
                std::array{0.0f, -0.0f, -0.25f, 3.0f, 1e30f, -1e-42f, kInfinity, std::nanf("")});
}

glm::vec4 random_color(Random& random, bool wild) {
  glm::vec4 color;
  for (int c = 0; c < 4; ++c) color[c] = random_channel(random, wild);
  return color;
}

/// A sheet of n x n quads, uneven and seen in perspective or all with w = 1, and some triangles of
/// any size; a part of it may be behind the eye or off the target.
Triangles random_triangles(Random& random, bool wild_colors) {
  const int n = random.integer(1, 14);
  const float reach = random.chance(0.3f) ? 2.5f : 0.95f;
  const bool flat = random.chance(0.5f);
  std::vector<glm::vec4> sheet;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const auto at = [&](int i) {
        return reach * (2.0f * static_cast<float>(i) / static_cast<float>(n) - 1.0f);
      };
      const float w = flat ? 1.0f : random.chance(0.02f) ? -0.5f : random.real(1.0f, 1.5f);
      sheet.push_back(glm::vec4(at(x) + random.real(-0.02f, 0.02f),
                                at(y) + random.real(-0.02f, 0.02f), random.real(-0.3f, 0.5f), 1) *
                      w);
    }
  Triangles out;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      for (const int i : {0, 1, n + 1, n + 1, 1, n + 2})
        out.positions.push_back(sheet[static_cast<std::size_t>(y * (n + 1) + x + i)]);
  for (int i = random.integer(0, 3); i > 0; --i)
    for (int k = 0; k < 3; ++k)
      out.positions.push_back({random.real(-1.5f, 1.5f), random.real(-1.5f, 1.5f),
                               random.real(-0.9f, 0.9f), random.real(0.8f, 1.2f)});
  for (std::size_t i = 0; i < out.positions.size(); ++i) {
    out.colors.push_back(random_color(random, wild_colors));
    out.normals.push_back({random.real(-1, 1), random.real(-1, 1), random.real(-0.3f, 2)});
  }
  if (random.chance(0.1f)) out.colors.clear();
  return out;
}

/// What takes shadows away from a picture most of the time, else anything.
ColorState random_color_state(Random& random) {
  ColorState state;
  if (random.chance(0.7f)) {
    state.blend = Blend{.color_op = BlendOp::reverse_subtract,
                        .src_color = BlendFactor::one,
                        .dst_color = BlendFactor::one};
    state.write[3] = false;
    if (random.chance(0.3f))
      state.blend->color_op =
          any_of(random, std::array{BlendOp::add, BlendOp::max, BlendOp::min, BlendOp::subtract});
    return state;
  }
  for (bool& write : state.write) write = random.chance(0.8f);
  if (random.chance(0.2f)) return state;
  Blend& blend = state.blend.emplace();
  const auto factor = [&] {
    return random.chance(0.5f) ? BlendFactor::one : static_cast<BlendFactor>(random.integer(0, 14));
  };
  blend = {static_cast<BlendOp>(random.integer(0, 4)),
           static_cast<BlendOp>(random.integer(0, 4)),
           factor(),
           factor(),
           factor(),
           factor(),
           random_color(random, false)};
  return state;
}

void fill_target(Random& random, ColorBuffer& color) {
  for (int y = 0; y < color.height(); ++y)
    for (int x = 0; x < color.width(); ++x) {
      if (color.format() == ColorFormat::rgba8) {
        for (std::uint8_t& channel : color.rgba8().at(x, y))
          channel = static_cast<std::uint8_t>(random.integer(0, 255));
        continue;
      }
      glm::vec4& stored = color.rgba32f().at(x, y);
      for (int c = 0; c < 4; ++c)
        stored[c] = random.chance(0.1f) ? -0.0f : random.real(-0.1f, 1.0f);
      // Not the NaN that is stored for a result.
      const std::uint32_t nan = 0xffc01234;
      if (random.chance(0.05f)) std::memcpy(&stored.x, &nan, sizeof nan);
    }
}

Shading random_shading(Random& random, const std::vector<Buffers>& sets, bool wild) {
  const auto lookup = [&] {
    return random_lookup(
        random,
        sets[static_cast<std::size_t>(random.integer(1, static_cast<int>(sets.size()) - 1))].depth);
  };
  if (random.chance(0.7f)) {
    Flat flat{random.chance(0.5f) ? glm::vec4(1.0f) : random_color(random, wild)};
    flat.depth_lookup = lookup();
    flat.depth_texture_mode =
        random.chance(0.7f)
            ? DepthTextureMode::luminance
            : any_of(random, std::array{DepthTextureMode::alpha, DepthTextureMode::intensity});
    return flat;
  }
  Lit lit;
  for (int i = random.integer(1, 6); i > 0; --i) {
    Light light;
    light.position = {random.real(-2, 2), random.real(-2, 2), random.real(0, 3),
                      random.chance(0.5f) ? 1.0f : 0.0f};
    if (random.chance(0.8f)) light.shadow_map = lookup();
    lit.lights.push_back(light);
  }
  lit.material.shininess = random.integer(0, 5);
  if (random.chance(0.5f)) lit.material.specular = glm::vec3(0.4f);
  lit.ambient = random.chance(0.5f);
  lit.two_sided = random.chance(0.5f);
  lit.eye_world = {0, 0, 3};
  return lit;
}

/// The triangles' depths, then draws over them that look maps up.
void record(Frame& frame, std::vector<Buffers>& sets, std::uint32_t seed) {
  Random random(seed);
  const bool wild = random.chance(0.2f);
  const Triangles triangles = random_triangles(random, wild);
  frame.begin_pass("depths", sets[0].all());
  record_draw(frame, {.state = {.depth = DepthState{}, .color = ColorState::off()}}, triangles);
  frame.begin_pass("lookups", sets[0].all());
  for (int i = 0; i < 4; ++i) {
    State state{.color = random_color_state(random)};
    if (random.chance(0.7f))
      state.depth =
          DepthState{random.chance(0.5f) ? CompareFunc::equal : CompareFunc::less_equal, false};
    if (random.chance(0.1f)) state.depth = DepthState{CompareFunc::greater, true};
    if (random.chance(0.1f))
      state.stencil =
          StencilState::both({.depth_fail = StencilOp::incr_wrap, .pass = StencilOp::incr});
    if (random.chance(0.2f)) state.scissor = Rect{3, 2, 40, 50};
    record_draw(frame, {.state = state, .shading = random_shading(random, sets, wild)}, triangles);
  }
}

}  // namespace

TEST(LookupShading, OfRandomMapsMeshesAndBlendsEqualsTheReference) {
  Grid grid("shading by depth lookups");
  int changed = 0, kept = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(seed + 5000);
    const Size size = std::array<Size, 3>{{{7, 5}, {63, 65}, {130, 70}}}[seed % 3];
    std::vector<Buffers> sets{Buffers(size, any_of(random, kDepthFormats),
                                      seed / 3 % 2 ? ColorFormat::rgba8 : ColorFormat::rgba32f)};
    fill_target(random, sets[0].color);
    for (int i = random.integer(1, 3); i > 0; --i) {
      sets.emplace_back(any_of(random, kMapSizes), any_of(random, kDepthFormats));
      fill_map(random, sets.back().depth);
    }
    const Buffers before = sets[0];
    const Expected expected = grid.check(
        "seed " + std::to_string(seed), sets,
        [&](Frame& frame, std::vector<Buffers>& buffers) { record(frame, buffers, seed); },
        seed % 20 < 3 ? Runs::every_variant : Runs::each_isa);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        ++(expected.buffers[0].color.at(x, y) == before.color.at(x, y) ? kept : changed);
  }
  EXPECT_GT(changed, 30000);
  EXPECT_GT(kept, 30000);
}
