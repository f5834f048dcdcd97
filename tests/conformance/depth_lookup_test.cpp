// Shadow maps: depth buffers that are looked up with comparison. Grid: 8 functions x nearest and
// linear x border and edge x D24 and D16 x map sizes, positions on texel edges and centres,
// outside, with q of every sign, infinite and not a number. Oracles:
// tests/reference/depth_lookup.h, which shares nothing with raster/, for the lookup; the slow
// reference for frames that draw a map, look it up, draw it again and look again; closed forms for
// what such a frame shows.
#include "reference/depth_lookup.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

constexpr std::array<Size, 5> kMapSizes{{{1, 1}, {2, 3}, {7, 5}, {16, 16}, {65, 9}}};
constexpr std::array<DepthTextureMode, 3> kModes{
    DepthTextureMode::luminance, DepthTextureMode::alpha, DepthTextureMode::intensity};

/// Random depths; the smallest and the largest, which alone a float can equal, come up often.
DepthBuffer random_map(Random& random, Size size, DepthFormat format) {
  DepthBuffer map(size.width, size.height, format);
  const int one = static_cast<int>(map.max_value());
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      map.plane().at(x, y) =
          static_cast<std::uint32_t>(random.chance(0.3f)   ? 0
                                     : random.chance(0.3f) ? one
                                                           : random.integer(0, one));
  return map;
}

float random_share(Random& random, int size) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto whole = static_cast<float>(random.integer(-1, size + 1));
  switch (random.integer(0, 6)) {
    case 0:  // a texel's edge
      return whole / static_cast<float>(size);
    case 1:  // a texel's centre
      return (whole + 0.5f) / static_cast<float>(size);
    case 2:  // next to an edge
      return std::nextafter(whole / static_cast<float>(size), random.real(-9.0f, 9.0f));
    case 3:  // outside, up to far beyond an int
      return random.real(-1.0f, 1.0f) * (random.chance(0.5f) ? 4.0f : 1e30f);
    case 4:
      return random.chance(0.1f) ? std::nanf("") : random.chance(0.2f) ? -kInfinity : 0.25f;
    default:
      return random.real(-0.2f, 1.2f);
  }
}

/// (s, t, r, q) with q of every kind.
glm::vec4 random_position(Random& random, const DepthBuffer& map) {
  glm::vec4 p{random_share(random, map.width()), random_share(random, map.height()), 0, 1};
  p.z = std::array{0.0f,
                   1.0f,
                   0.5f,
                   random.real(-0.2f, 1.2f),
                   static_cast<float>(map.at(0, 0)) / static_cast<float>(map.max_value()),
                   1e-42f,
                   std::nanf("")}[static_cast<std::size_t>(random.integer(0, 6))];
  const float q =
      std::array{1.0f,  1.0f,
                 2.0f,  random.real(0.1f, 5.0f),
                 -1.0f, random.real(-3.0f, 0.0f),
                 0.0f,  std::numeric_limits<float>::infinity()}[static_cast<std::size_t>(
          random.integer(0, 7))];
  if (q == 0.0f || std::isinf(q)) return {p.x, p.y, p.z, q};
  return p * q;
}

glm::mat4 random_matrix(Random& random) {
  glm::mat4 m(1.0f);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m[c][r] = (c == r ? 1.0f : 0.0f) + random.real(-0.3f, 0.3f);
  return m;
}

bool same_bits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Clip space to a map's s, t and r; turned round, a pixel reads the opposite end of the map.
glm::mat4 map_from_clip(bool turned = false) {
  glm::mat4 m(0.5f);
  if (turned) m[0][0] = m[1][1] = -0.5f;
  m[3] = {0.5f, 0.5f, 0.5f, 1.0f};
  return m;
}

/// Passes of one method's frame: a map is drawn, looked up, drawn again and looked up again.
void record_twice(Frame& frame, std::vector<Buffers>& sets, const Shading& first,
                  const Shading& second) {
  const auto scene = [](float z) {
    return std::vector<glm::vec4>{{-1, -0.9f, z, 1},  {0.7f, -1, z + 0.3f, 1},
                                  {0.1f, 0.9f, z, 1}, {0, 0, z - 0.2f, 1},
                                  {2, 0, 0.4f, 2},    {1, 1.2f, 0.1f, 1.3f}};
  };
  const State drawing{.depth = DepthState{}};
  float z = -0.2f;
  for (const Shading& shading : {first, second}) {
    frame.begin_pass("map", {.depth = &sets[1].depth});
    frame.clear({.depth = 1.0f});
    record_draw(frame, {.state = drawing}, {scene(z)});
    frame.begin_pass("picture", sets[0].all());
    const std::vector<glm::vec4> corners = full_quad(0.1f);
    record_draw(frame,
                {.state = {.scissor = z < 0 ? std::nullopt : std::optional(Rect{0, 0, 40, 3})},
                 .shading = shading},
                {.positions = corners,
                 .normals = std::vector<glm::vec3>(corners.size(), {0.1f, 0.2f, 1.0f})});
    z = 0.5f;
  }
}

}  // namespace

TEST(DepthLookup, OfAnyPositionIsTheIndependentOnesShareToTheBit) {
  Grid grid("depth lookups");
  Random random(12);
  std::array<int, 3> kinds{};
  for (const CompareFunc func : kFuncs)
    for (const Filter filter : {Filter::nearest, Filter::linear})
      for (const std::optional<float>& border : {std::optional<float>(1.0f),
                                                 {std::numeric_limits<float>::quiet_NaN()},
                                                 {0.5f},
                                                 {-3.0f},
                                                 std::optional<float>()})
        for (const DepthFormat format : kDepthFormats)
          for (const Size size : kMapSizes) {
            const DepthBuffer map = random_map(random, size, format);
            DepthLookup lookup{.map = &map, .func = func, .filter = filter, .border = border};
            std::uint64_t differing = 0;
            constexpr int kPositions = 500;
            for (int i = 0; i < kPositions; ++i) {
              lookup.map_from_position = i % 2 ? glm::mat4(1.0f) : random_matrix(random);
              const glm::vec4 p = random_position(random, map);
              const float got = compare_depth(lookup, p);
              const float wanted = gnomon::reference::compare_depth(lookup, p);
              ++kinds[got == 0.0f ? 0u : got == 1.0f ? 1u : 2u];
              if (same_bits(got, wanted)) continue;
              differing += sizeof got;
              ADD_FAILURE() << text(func) << " at " << p.x << ' ' << p.y << ' ' << p.z << ' ' << p.w
                            << ": " << got << ", not " << wanted;
            }
            grid.count(kPositions, 1, differing);
          }
  // Shares of 0, of 1 and in between all came up.
  for (const int n : kinds) EXPECT_GT(n, 20000);
}

TEST(DepthLookup, OnATexelsEdgeReadsTheTexelAfterIt) {
  // Closed form: coordinate k / n of n texels is where texel k begins; a linear lookup there weighs
  // both sides by a half.
  DepthBuffer map(8, 1);
  for (int x = 0; x < 8; ++x) map.plane().at(x, 0) = x % 2 ? 0xffffff : 0;
  DepthLookup lookup{.map = &map, .func = CompareFunc::less};
  for (int k = 0; k <= 8; ++k) {
    const glm::vec4 p{static_cast<float>(k) / 8.0f, 0.5f, 0.5f, 1.0f};
    lookup.filter = Filter::nearest;
    EXPECT_EQ(compare_depth(lookup, p), k % 2 || k == 8 ? 1.0f : 0.0f) << k;
    EXPECT_EQ(compare_depth(lookup, -p), compare_depth(lookup, p)) << k;
    lookup.filter = Filter::linear;
    EXPECT_EQ(compare_depth(lookup, p), k == 8 ? 1.0f : 0.5f) << k;
  }
}

TEST(DepthLookup, ByAFlatColorReadsTheTexelUnderThePixel) {
  // Closed form: pixels map to a map eight times coarser, away from texel edges.
  Grid grid("depth lookups by flat colours");
  Random random(13);
  for (const DepthFormat format : kDepthFormats)
    for (const CompareFunc func : kFuncs)
      for (const DepthTextureMode mode : kModes) {
        constexpr Size kSize{128, 72};
        Buffers map({16, 9}, format);
        map.depth = random_map(random, {16, 9}, format);
        const std::string name = text(format) + " " + text(func);
        const Expected expected = grid.check(
            name, {Buffers(kSize, format), map}, [&](Frame& frame, std::vector<Buffers>& sets) {
              Flat flat{{1, 1, 1, 1}};
              flat.depth_lookup = DepthLookup{
                  .map = &sets[1].depth, .map_from_position = map_from_clip(), .func = func};
              flat.depth_texture_mode = mode;
              frame.begin_pass("lookup", sets[0].all());
              record_draw(frame, {.shading = flat}, {full_quad(-0.26f)});
            });
        for (int y = 0; y < kSize.height; ++y)
          for (int x = 0; x < kSize.width; ++x) {
            // 0.37 of the largest depth; no texel comes nearer to it than float32 can tell.
            const double texel = map.depth.at(x / 8, y / 8), r = 0.37 * map.depth.max_value();
            const auto on = static_cast<std::uint8_t>(
                (static_cast<int>(func) >> (r < texel ? 0 : 2) & 1) != 0 ? 255 : 0);
            const std::uint8_t rgb = mode == DepthTextureMode::alpha ? 255 : on,
                               alpha = mode == DepthTextureMode::luminance ? 255 : on;
            ASSERT_EQ(expected.buffers[0].color.rgba8().at(x, y), (Rgba8{rgb, rgb, rgb, alpha}))
                << name << " at " << x << ' ' << y;
          }
      }
}

TEST(DepthLookup, SeesWhatWasDrawnBeforeAndNothingLater) {
  // Closed form: the map holds 0.75 at the first look and 0.25 at the second; the reference is 0.5.
  // Turned round, a tile reads what other tiles have drawn, so it must neither run ahead nor lag.
  Grid grid("depth lookups in order");
  for (const Size map_size : {Size{130, 70}, Size{64, 64}, Size{7, 5}})
    for (const Size size : kSizes)
      for (const bool turned : {false, true}) {
        const Expected expected = grid.check(
            text(map_size) + " " + text(size), {Buffers(size), Buffers(map_size)},
            [&](Frame& frame, std::vector<Buffers>& sets) {
              Flat flat{{1, 1, 1, 1}};
              flat.depth_lookup = DepthLookup{.map = &sets[1].depth,
                                              .map_from_position = map_from_clip(turned),
                                              .filter = turned ? Filter::linear : Filter::nearest,
                                              .border = std::nullopt};
              for (const bool second : {false, true}) {
                frame.begin_pass("map", {.depth = &sets[1].depth});
                record_draw(frame, {.state = {.depth = DepthState{CompareFunc::always, true}}},
                            {full_quad(second ? -0.5f : 0.5f)});
                frame.begin_pass("lookup", sets[0].all());
                // The second look is added in green.
                record_draw(frame,
                            {.state = {.color = {.write = {!second, second, false, false}}},
                             .shading = flat},
                            {full_quad()});
              }
            },
            size.width == 130 ? Runs::every_variant : Runs::each_isa);
        const Buffers& picture = expected.buffers[0];
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x)
            ASSERT_EQ(picture.color.rgba8().at(x, y), (Rgba8{255, 0, 0, 0})) << x << ' ' << y;
      }
}

TEST(DepthLookup, OfAMapDrawnTwiceEqualsTheReference) {
  Grid grid("depth lookups of drawn maps");
  for (const Size map_size : {Size{63, 65}, Size{32, 32}, Size{130, 70}})
    for (const Size size : {Size{7, 5}, Size{63, 65}, Size{130, 70}})
      for (const DepthFormat format : kDepthFormats)
        for (const Filter filter : {Filter::nearest, Filter::linear})
          for (const CompareFunc func :
               {CompareFunc::less_equal, CompareFunc::greater, CompareFunc::not_equal}) {
            const bool edge = func == CompareFunc::greater;
            const bool crossed = func == CompareFunc::less_equal && size.width == 130 &&
                                 map_size.width == 130 && format == DepthFormat::d24;
            const Record record = [&](Frame& frame, std::vector<Buffers>& sets) {
              DepthLookup lookup{.map = &sets[1].depth,
                                 .map_from_position = map_from_clip(),
                                 .func = func,
                                 .filter = filter};
              lookup.map_from_position[3][2] -= 0.01f;
              if (edge) lookup.border.reset();
              Flat flat{{0.9f, 0.8f, 0.7f, 0.6f}};
              flat.depth_lookup = lookup;
              flat.depth_texture_mode = kModes[static_cast<std::size_t>(func) % 3];
              Lit lit;
              lit.lights.push_back({.position = {0.3f, 0.4f, 2.0f, 1.0f}, .shadow_map = lookup});
              lit.scene_ambient = glm::vec3(0.1f);
              lit.material.specular = glm::vec3(0.3f);
              lit.material.shininess = 3;
              lit.eye_world = {0, 0, 3};
              if (filter == Filter::nearest)
                record_twice(frame, sets, flat, lit);
              else
                record_twice(frame, sets, lit, flat);
            };
            const ColorFormat color =
                format == DepthFormat::d24 ? ColorFormat::rgba32f : ColorFormat::rgba8;
            grid.check(text(map_size) + " into " + text(size),
                       {Buffers(size, DepthFormat::d24, color), Buffers(map_size, format)}, record,
                       crossed ? Runs::every_variant : Runs::each_isa);
          }
}
