// The rules of docs/semantics.md on frames small enough to know the answer by hand (oracle: closed
// forms and invariants).
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "random_frames.h"
#include "raster/execute.h"
#include "small_frames.h"

using namespace gnomon::raster;
using namespace gnomon::small_frames;
using gnomon::random_frames::Random;

TEST(Coverage, TiesGoToLeftAndBottomEdges) {
  StencilBuffer stencil(8, 8);
  Frame frame;
  frame.begin_pass("square", {.stencil = &stencil});
  const auto p = [](double x, double y) { return at_window(x, y, 8, 8); };
  draw_positions(frame, counting(),
                 {p(1.5, 1.5), p(5.5, 1.5), p(5.5, 5.5), p(1.5, 1.5), p(5.5, 5.5), p(1.5, 5.5)});
  execute(frame);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(stencil.at(x, y), x >= 1 && x <= 4 && y >= 1 && y <= 4) << x << ' ' << y;
}

TEST(Depth, StaysWithinOneUnitOfTheExactPlane) {
  // Oracle: the plane through the snapped vertices in long double (64-bit mantissa; error far below
  // a unit).
  Random random(23);
  for (int round = 0; round < 400; ++round) {
    const int width = round % 4 ? 100 : 8192, height = round % 4 ? 80 : 40;
    DepthBuffer depth(width, height);
    std::array<std::array<double, 3>, 3> v{};
    for (auto& p : v)
      p = {random.integer(0, width * 256) / 256.0, random.integer(0, height * 256) / 256.0,
           random.integer(0, 1 << 23) / static_cast<double>(1 << 23)};
    // Every other one is a sliver: its third corner is within a pixel of the first.
    if (round % 2)
      v[2] = {v[0][0] + random.integer(-256, 256) / 256.0,
              v[0][1] + random.integer(-256, 256) / 256.0, v[2][2]};
    Frame frame;
    frame.begin_pass("triangle", {.depth = &depth});
    frame.clear({.depth = 1.0f});
    std::vector<glm::vec4> clip;
    for (const auto& p : v) clip.push_back(at_window(p[0], p[1], width, height, p[2]));
    draw_positions(frame, {.depth = DepthState{CompareFunc::always, true}}, clip);
    execute(frame);
    const long double x1 = v[1][0] - v[0][0], y1 = v[1][1] - v[0][1], z1 = v[1][2] - v[0][2];
    const long double x2 = v[2][0] - v[0][0], y2 = v[2][1] - v[0][1], z2 = v[2][2] - v[0][2];
    const long double area = x1 * y2 - x2 * y1;
    if (area == 0) continue;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (depth.at(x, y) == 0xffffff) continue;
        const long double dx = x + 0.5L - v[0][0], dy = y + 0.5L - v[0][1];
        const long double z =
            v[0][2] + (dx * (z1 * y2 - z2 * y1) + dy * (x1 * z2 - x2 * z1)) / area;
        ASSERT_LE(std::abs(depth.at(x, y) - z * 0xffffff), 1.0L + 0x1p-9L) << "round " << round;
      }
  }
}

TEST(Depth, ClampKeepsFragmentsBeyondTheFarPlane) {
  DepthBuffer depth(4, 4);
  for (const bool clamp : {false, true}) {
    Frame frame;
    frame.begin_pass("beyond", {.depth = &depth});
    frame.clear({.depth = 0.25f});
    State state{.depth = DepthState{CompareFunc::always, true}, .depth_range = {0.0f, 0.75f}};
    state.depth_clamp = clamp;
    draw_positions(frame, state, {{-3, -3, 2, 1}, {9, -3, 2, 1}, {-3, 9, 2, 1}});
    execute(frame);
    const auto value = static_cast<std::uint32_t>(std::lrint((clamp ? 0.75 : 0.25) * 0xffffff));
    EXPECT_EQ(depth.at(2, 2), value);
  }
}

TEST(Depth, OffsetUnitsMoveByWholeUnits) {
  for (const DepthFormat format : {DepthFormat::d24, DepthFormat::d16}) {
    DepthBuffer plain(5, 5, format), moved(5, 5, format);
    const std::vector<glm::vec4> slope{{-1, -1, -0.3f, 1}, {3, -1, 0.2f, 1}, {-1, 3, 0.1f, 1}};
    Frame frame;
    State state{.depth = DepthState{CompareFunc::always, true}};
    frame.begin_pass("plain", {.depth = &plain});
    draw_positions(frame, state, slope);
    state.polygon_offset = PolygonOffset{0.0f, -3.0f};
    frame.begin_pass("moved", {.depth = &moved});
    draw_positions(frame, state, slope);
    execute(frame);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 5; ++x) EXPECT_EQ(moved.at(x, y) + 3, plain.at(x, y));
  }
}

TEST(Stencil, IncrementWrapGoesFrom255To0AndIncrementStays) {
  for (const auto& [op, expected] : {std::pair{StencilOp::incr_wrap, 0}, {StencilOp::incr, 255}}) {
    StencilBuffer stencil(3, 3);
    Frame frame;
    frame.begin_pass("wrap", {.stencil = &stencil});
    frame.clear({.stencil = 255});
    State state = counting();
    state.stencil->front.pass = op;
    draw_positions(frame, state, {{-1, -1, 0, 1}, {3, -1, 0, 1}, {-1, 3, 0, 1}});
    execute(frame);
    EXPECT_EQ(stencil.at(1, 1), expected);
  }
}

TEST(Blending, DividesExactlyAndRoundsToNearest) {
  // Oracle: the rational (255 - a) d / 255, rounded, for every a and d.
  ColorBuffer color(256, 256);
  std::vector<std::uint8_t> ramp;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x)
      for (int c = 0; c < 3; ++c) ramp.push_back(static_cast<std::uint8_t>(x));
  Frame frame;
  frame.begin_pass("blend", {.color = &color});
  frame.blit({.image = {ramp.data(), 256, 256, 3, 256 * 3}});
  const Blend darken{.src_color = BlendFactor::zero, .dst_color = BlendFactor::one_minus_src_alpha};
  for (int a = 0; a < 256; ++a) {
    auto quad = std::make_shared<std::array<glm::vec4, 3>>(
        std::array<glm::vec4, 3>{glm::vec4{-1, -1, 0, 1}, {3, -1, 0, 1}, {-1, 3, 0, 1}});
    frame.keep(quad);
    static const std::array<std::uint32_t, 3> indices{0, 1, 2};
    frame.draw({.state = {.color = {.blend = darken}, .scissor = Rect{0, a, 256, 1}},
                .mesh = {.positions = *quad, .indices = indices},
                .shading = Flat{{0, 0, 0, static_cast<float>(a) / 255.0f}, {}}});
  }
  execute(frame);
  for (int a = 0; a < 256; ++a)
    for (int d = 0; d < 256; ++d)
      ASSERT_EQ(color.rgba8().at(d, a)[0], (2 * (255 - a) * d + 255) / 510) << a << ' ' << d;
}

TEST(Blending, StoresEveryNanAsTheSameBits) {
  // Oracle: the documented bits. x86's own NaN is 0xffc00000, AArch64's 0x7fc00000.
  ColorBuffer color(1, 1, ColorFormat::rgba32f);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Frame frame;
  frame.begin_pass("clear", {.color = &color});
  frame.clear({.color = glm::vec4(kInfinity)});
  // Infinity minus infinity.
  const Blend subtract{.color_op = BlendOp::subtract,
                       .alpha_op = BlendOp::subtract,
                       .dst_color = BlendFactor::one,
                       .dst_alpha = BlendFactor::one};
  const std::array<glm::vec4, 3> corners{glm::vec4{-1, -1, 0, 1}, {3, -1, 0, 1}, {-1, 3, 0, 1}};
  const std::array<std::uint32_t, 3> indices{0, 1, 2};
  frame.draw({.state = {.color = {.blend = subtract}},
              .mesh = {.positions = corners, .indices = indices},
              .shading = Flat{glm::vec4(kInfinity)}});
  execute(frame);
  for (int c = 0; c < 4; ++c)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(color.at(0, 0)[c]), 0x7fc00000u);
}

TEST(Frame, MisuseNamesTheRule) {
  Frame frame;
  EXPECT_THROW(frame.begin_pass("none", {}), std::invalid_argument);
  EXPECT_THROW(frame.clear({}), std::invalid_argument);
  ColorBuffer color(2, 2);
  DepthBuffer depth(3, 2);
  EXPECT_THROW(frame.begin_pass("sizes", {.color = &color, .depth = &depth}),
               std::invalid_argument);
  frame.begin_pass("color", {.color = &color});
  EXPECT_THROW(frame.clear({.depth = 1.0f}), std::invalid_argument);
  const std::array<glm::vec4, 1> one{};
  const std::array<std::uint32_t, 3> wrong{0, 0, 1};
  EXPECT_THROW(frame.draw({.mesh = {.positions = one, .indices = wrong}}), std::invalid_argument);
  EXPECT_THROW(ColorBuffer(0, 5), std::invalid_argument);
  EXPECT_THROW(depth.at(3, 0), std::invalid_argument);
}

TEST(Depth, OfAClippedTriangleDoesNotDependOnTheOrderOfItsVertices) {
  Random random(41);
  int drawn = 0;
  for (int round = 0; round < 200; ++round) {
    std::array<glm::vec4, 3> v;
    for (glm::vec4& p : v) {
      const float x = random.real(-3.0f, 3.0f), y = random.real(-3.0f, 3.0f);
      p = {x, y, random.real(-2.0f, 2.0f), random.real(-1.0f, 2.0f)};
    }
    std::vector<std::uint32_t> first;
    for (const std::array<int, 3>& order :
         {std::array{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}) {
      DepthBuffer depth(60, 50);
      Frame frame;
      frame.begin_pass("triangle", {.depth = &depth});
      const auto at = [&](std::size_t i) { return v[static_cast<std::size_t>(order[i])]; };
      draw_positions(frame, {.depth = DepthState{CompareFunc::always, true}},
                     {at(0), at(1), at(2)});
      execute(frame);
      if (first.empty()) first = depth.to_rows();
      ASSERT_EQ(depth.to_rows(), first) << "round " << round;
    }
    drawn += first != DepthBuffer(60, 50).to_rows();
  }
  EXPECT_GT(drawn, 50);
}
