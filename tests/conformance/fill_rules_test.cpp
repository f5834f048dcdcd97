// Which pixels a triangle covers. Grids: dEQP rasterization.fill_rules.* (basic quads both ways,
// clipped, projected), piglit triangle-rasterization and triangle-rasterization-overdraw, fans
// round hubs on pixel centres and edges. Oracles: the slow reference for the bytes; 64-bit edge
// functions of this file at the sample point (x + e, y + e^2), e infinitely small, which belongs to
// a left and to a bottom edge; that shared edges cover each pixel once.
#include <gtest/gtest.h>

#include <algorithm>

#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

/// Window coordinates in 1/256 pixel.
struct Point {
  std::int64_t x, y;
};

State counting(BlendOp op = BlendOp::add) {
  return {.stencil = StencilState::both({.pass = StencilOp::incr_wrap}),
          .color = {.blend = Blend{.color_op = op,
                                   .alpha_op = op,
                                   .dst_color = BlendFactor::one,
                                   .dst_alpha = BlendFactor::one}}};
}

void record(Frame& frame, const std::vector<Point>& corners, Size size) {
  std::vector<glm::vec4> positions;
  for (const Point& p : corners)
    positions.push_back(
        at_window(static_cast<double>(p.x) / 256, static_cast<double>(p.y) / 256, size));
  record_draw(frame, {.state = counting(), .shading = Flat{{0.2f, 0.4f, 0.6f, 1.0f / 255}}},
              {positions});
}

/// Whether the sample point is left of the directed line, which no such point lies on.
bool left_of(const Point& a, const Point& b, const Point& p) {
  const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
  const std::int64_t e = dx * (p.y - a.y) - dy * (p.x - a.x);
  if (e != 0) return e > 0;
  return dy != 0 ? dy < 0 : dx > 0;
}

bool covers(Point a, Point b, Point c, const Point& p) {
  const std::int64_t area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (area == 0) return false;
  if (area < 0) std::swap(b, c);
  return left_of(a, b, p) && left_of(b, c, p) && left_of(c, a, p);
}

/// How many of the triangles cover each pixel, row after row.
std::vector<std::uint8_t> counts(const std::vector<Point>& corners, Size size) {
  std::vector<std::uint8_t> out;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Point centre{x * 256 + 128, y * 256 + 128};
      int n = 0;
      for (std::size_t i = 0; i < corners.size(); i += 3)
        n += covers(corners[i], corners[i + 1], corners[i + 2], centre);
      out.push_back(static_cast<std::uint8_t>(n));
    }
  return out;
}

Point random_point(Random& random, Size size, int grid) {
  const int x = random.integer(-2 * 256 / grid, (size.width + 2) * 256 / grid) * grid;
  return {x, random.integer(-2 * 256 / grid, (size.height + 2) * 256 / grid) * grid};
}

void expect_counts(const Expected& expected, const std::vector<std::uint8_t>& wanted,
                   const std::string& name) {
  EXPECT_EQ(expected.only().stencil.to_rows(), wanted) << name;
}

/// A quad a b c d as two triangles, cut along a c or, reversed, wound the other way.
std::vector<Point> as_triangles(const std::array<Point, 4>& q, bool reverse) {
  if (reverse) return {q[0], q[2], q[1], q[0], q[3], q[2]};
  return {q[0], q[1], q[2], q[0], q[2], q[3]};
}

}  // namespace

TEST(FillRules, RandomTrianglesCoverWhatTheirEdgeFunctionsSay) {  // piglit triangle-rasterization
  Grid grid("fill rules: random triangles");
  Random random(1);
  for (int round = 0; round < 400; ++round)
    for (const Size size : kSizes) {
      // Corners on sub-pixels, on quarter pixels, on centres and corners of pixels.
      const int spacing = std::array{1, 64, 128, 256}[static_cast<std::size_t>(round % 4)];
      std::vector<Point> corners;
      for (int i = 0; i < 3; ++i) corners.push_back(random_point(random, size, spacing));
      const std::string name = "round " + std::to_string(round);
      const Expected expected = grid.check(
          name, Buffers(size), [&](Frame& frame, auto&) { record(frame, corners, size); },
          round % 50 ? Runs::each_isa : Runs::every_variant);
      expect_counts(expected, counts(corners, size), name);
    }
}

TEST(FillRules, ProblemTrianglesCoverWhatTheirEdgeFunctionsSay) {
  Grid grid("fill rules: problem triangles");
  constexpr Size kSize{63, 65};
  Random random(2);
  for (int round = 0; round < 600; ++round) {
    const Point a = random_point(random, kSize, 1);
    const auto near = [&](const Point& p, int reach) {
      const int x = random.integer(-reach, reach);
      return Point{p.x + x, p.y + random.integer(-reach, reach)};
    };
    std::vector<Point> corners;
    switch (round % 6) {
      case 0:  // smaller than a pixel
        corners = {a, near(a, 128), near(a, 128)};
        break;
      case 1:  // smaller than a sub-pixel's square, on a pixel's centre
        corners = {{a.x / 256 * 256 + 128, a.y / 256 * 256 + 128}, {}, {}};
        corners[1] = near(corners[0], 1);
        corners[2] = near(corners[0], 1);
        break;
      case 2: {  // a needle
        const Point b = random_point(random, kSize, 1);
        corners = {a, b, near(b, 3)};
        break;
      }
      case 3:  // level and upright edges through centres
        corners = {{a.x / 256 * 256 + 128, a.y / 256 * 256 + 128}, {}, {}};
        corners[1] = {corners[0].x + 256 * random.integer(-30, 30), corners[0].y};
        corners[2] = {corners[0].x, corners[0].y + 256 * random.integer(-30, 30)};
        break;
      case 4: {  // no area
        const int t = random.integer(-9, 9);
        const Point step = near({0, 0}, 700);
        corners = {a, {a.x + step.x, a.y + step.y}, {a.x + t * step.x, a.y + t * step.y}};
        break;
      }
      default:  // far outside on two sides
        corners = {{a.x - 256 * 9000, a.y}, {a.x + 256 * 9000, near(a, 900).y}, near(a, 900)};
        break;
    }
    const std::string name = "round " + std::to_string(round);
    const Expected expected = grid.check(
        name, Buffers(kSize), [&](Frame& frame, auto&) { record(frame, corners, kSize); });
    expect_counts(expected, counts(corners, kSize), name);
  }
}

TEST(FillRules, QuadsCoverEachPixelOnce) {  // dEQP basic_quad, basic_quad_reverse, clipped_*
  Grid grid("fill rules: quads");
  Random random(3);
  for (int round = 0; round < 200; ++round)
    for (const Size size : kSizes)
      for (const bool reverse : {false, true}) {
        const Point low = random_point(random, size, round % 2 ? 1 : 128);
        const Point high{low.x + random.integer(1, 256 * size.width),
                         low.y + random.integer(1, 256 * size.height)};
        const std::array<Point, 4> q{low, Point{high.x, low.y}, high, Point{low.x, high.y}};
        const std::string name = "round " + std::to_string(round);
        const Expected expected = grid.check(name, Buffers(size), [&](Frame& frame, auto&) {
          record(frame, as_triangles(q, reverse), size);
        });
        for (int y = 0; y < size.height; ++y)
          for (int x = 0; x < size.width; ++x) {
            const std::int64_t cx = x * 256 + 128, cy = y * 256 + 128;
            ASSERT_EQ(expected.only().stencil.at(x, y),
                      cx >= low.x && cx < high.x && cy >= low.y && cy < high.y)
                << name;
          }
      }
}

TEST(FillRules, FansOverdrawNothingAndLeaveNoHole) {  // piglit triangle-rasterization-overdraw
  Grid grid("fill rules: fans");
  Random random(4);
  for (int round = 0; round < 120; ++round)
    for (const Size size : kSizes) {
      const Point hub = random_point(random, size, round % 3 ? 1 : 128);
      const std::int64_t left = std::min<std::int64_t>(hub.x, 0) - 300,
                         bottom = std::min<std::int64_t>(hub.y, 0) - 300;
      const std::int64_t right = std::max<std::int64_t>(hub.x, size.width * 256) + 300,
                         top = std::max<std::int64_t>(hub.y, size.height * 256) + 300;
      std::vector<Point> rim;
      for (int i = 0; i < 6; ++i) rim.push_back({left + (right - left) * i / 6, bottom});
      for (int i = 0; i < 6; ++i) rim.push_back({right, bottom + (top - bottom) * i / 6});
      for (int i = 0; i < 6; ++i) rim.push_back({right - (right - left) * i / 6, top});
      for (int i = 0; i < 6; ++i) rim.push_back({left, top - (top - bottom) * i / 6});
      std::vector<Point> corners;
      for (std::size_t i = 0; i < rim.size(); ++i) {
        corners.insert(corners.end(), {hub, rim[i], rim[(i + 1) % rim.size()]});
        if (random.chance(0.5f)) std::swap(corners[3 * i + 1], corners[3 * i + 2]);
      }
      const std::string name = "round " + std::to_string(round);
      const Expected expected = grid.check(
          name, Buffers(size), [&](Frame& frame, auto&) { record(frame, corners, size); });
      for (const std::uint8_t s : expected.only().stencil.to_rows()) ASSERT_EQ(s, 1) << name;
      // The colour adds up as the count does.
      for (const std::uint8_t c : expected.only().color.to_rgba8_rows())
        ASSERT_TRUE(c == 51 || c == 102 || c == 153 || c == 1) << name;
    }
}

TEST(FillRules, ProjectedMeshesCoverEachPixelAtMostOnce) {  // dEQP fill_rules.projected
  Grid grid("fill rules: projected meshes");
  Random random(5);
  for (int round = 0; round < 100; ++round)
    for (const Size size : kSizes) {
      // A warped sheet of 6 x 6 cells seen under perspective, partly behind the eye.
      std::array<std::array<glm::vec4, 7>, 7> sheet;
      for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 7; ++j) {
          const float u = static_cast<float>(i) / 3.0f - 1.0f,
                      v = static_cast<float>(j) / 3.0f - 1.0f;
          const float w = 1.0f + 0.8f * u + static_cast<float>(round % 5) * 0.15f * v;
          sheet[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = {2 * u + 0.1f * v,
                                                                             2 * v, 0.3f * w, w};
        }
      std::vector<glm::vec4> positions;
      for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j) {
          const glm::vec4 a = sheet[i][j], b = sheet[i + 1][j], c = sheet[i + 1][j + 1],
                          d = sheet[i][j + 1];
          if (random.chance(0.5f))
            positions.insert(positions.end(), {a, b, c, a, c, d});
          else
            positions.insert(positions.end(), {b, c, d, b, d, a});
        }
      const std::string name = "round " + std::to_string(round);
      const Expected expected = grid.check(name, Buffers(size), [&](Frame& frame, auto&) {
        record_draw(frame, {.state = counting()}, {positions});
      });
      for (const std::uint8_t s : expected.only().stencil.to_rows()) ASSERT_LE(s, 1) << name;
      EXPECT_GT(expected.outcomes.pass, 0u) << name;
    }
}

TEST(FillRules, AMeshOfManyChunksCoversWhatItsEdgeFunctionsSay) {
  // More triangles and vertices than one chunk of the front end holds.
  Grid grid("fill rules: one large mesh");
  constexpr Size kSize{130, 70};
  Random random(6);
  std::vector<Point> corners;
  for (int i = 0; i < 2000; ++i) {
    const Point a = random_point(random, kSize, 1);
    for (int k = 0; k < 3; ++k)
      corners.push_back({a.x + random.integer(-900, 900), a.y + random.integer(-900, 900)});
  }
  const Expected expected = grid.check(
      "2000 triangles", Buffers(kSize), [&](Frame& frame, auto&) { record(frame, corners, kSize); },
      Runs::every_variant);
  expect_counts(expected, counts(corners, kSize), "2000 triangles");
}
