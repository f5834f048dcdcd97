// Polygon offset: factor * m + units * r. Grids: dEQP polygon_offset.* (factor, units, both signs,
// clamped results), piglit polygon-offset (r by bisection). Oracles: the slow reference for the
// bytes; closed forms on flat and on exactly sloped planes; for r, bisection.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "every_value.h"
#include "grid.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;

namespace {

constexpr std::array<float, 7> kFactors{-2.0f, -1.0f, -0.5f, 0.0f, 0.5f, 1.0f, 4.0f};
constexpr std::array<float, 11> kUnits{-1e9f, -1000.0f, -2.0f, -1.0f,  -0.5f, 0.0f,
                                       0.5f,  1.0f,     2.0f,  777.0f, 1e9f};

std::uint32_t one(DepthFormat format) { return format == DepthFormat::d24 ? 0xffffff : 0xffff; }

State offset_state(const PolygonOffset& offset) {
  return {.depth = DepthState{CompareFunc::always, true}, .polygon_offset = offset};
}

/// What one pixel of a flat quad at z_ndc stores; every instruction set agrees.
std::uint32_t flat_depth(Grid& grid, DepthFormat format, float z_ndc, float units) {
  const Expected expected =
      grid.check("z " + std::to_string(z_ndc) + " units " + std::to_string(units),
                 Buffers({1, 1}, format), [&](Frame& frame, auto&) {
                   record_draw(frame, {.state = offset_state({0.0f, units})}, {full_quad(z_ndc)});
                 });
  return expected.only().depth.at(0, 0);
}

/// The least float in (low, high] for which holds() is true, which it stays above.
template <class Holds>
float bisect(float low, float high, Holds holds) {
  while (true) {
    const float middle = low + (high - low) * 0.5f;
    if (middle <= low || middle >= high) return high;
    (holds(middle) ? high : low) = middle;
  }
}

}  // namespace

TEST(PolygonOffset, EveryFactorAndUnitEqualsTheReferenceOnEverySlope) {
  Grid grid("polygon offset factors x units x slopes");
  const std::array<glm::vec2, 5> slopes{
      glm::vec2{0, 0}, {0.9f, 0}, {0, -0.9f}, {-0.4f, 0.5f}, {0.001f, 0.002f}};
  for (const DepthFormat format : kDepthFormats)
    for (const float factor : kFactors)
      for (const float units : kUnits)
        for (const glm::vec2& slope : slopes)
          for (const bool clamp : {false, true})
            for (const Size size : {Size{7, 5}, Size{63, 65}}) {
              State state = offset_state({factor, units});
              state.depth_clamp = clamp;
              state.depth_range = {0.125f, 0.875f};
              grid.check("factor " + std::to_string(factor) + " units " + std::to_string(units),
                         Buffers(size, format), [&](Frame& frame, auto&) {
                           std::vector<glm::vec4> corners = full_quad();
                           for (glm::vec4& p : corners) p.z = slope.x * p.x + slope.y * p.y;
                           record_draw(frame, {.state = state}, {corners});
                         });
            }
}

TEST(PolygonOffset, FactorOneMovesByTheSlopeAndUnitsByUnits) {
  // A plane that rises by whole units a pixel, on a target whose pixel centres are exact.
  Grid grid("polygon offset closed forms");
  constexpr Size kSize{64, 16};
  for (const DepthFormat format : kDepthFormats)
    for (const int rise_x : {0, 1, 3, -2})
      for (const int rise_y : {0, 2, -5})
        for (const int factor : {-3, -1, 0, 1, 2})
          for (const int units : {-7, -1, 0, 1, 5}) {
            // Near the middle z_ndc is small, and float32 holds it to far below a unit.
            const int base = static_cast<int>(middle_depth(format));
            const int slope = std::max(std::abs(rise_x), std::abs(rise_y));
            const auto depth_at = [&](double x, double y) {
              return (base + rise_x * (x - 0.5) + rise_y * (y - 0.5)) / one(format);
            };
            const Expected expected =
                grid.check("rise " + std::to_string(rise_x) + " " + std::to_string(rise_y),
                           Buffers(kSize, format), [&](Frame& frame, auto&) {
                             std::vector<glm::vec4> corners;
                             for (const glm::ivec2& c :
                                  {glm::ivec2{0, 0}, {64, 0}, {64, 16}, {0, 0}, {64, 16}, {0, 16}})
                               corners.push_back(at_window(c.x, c.y, kSize, depth_at(c.x, c.y)));
                             record_draw(frame,
                                         {.state = offset_state({static_cast<float>(factor),
                                                                 static_cast<float>(units)})},
                                         {corners});
                           });
            // Vertex depths are off by less than 2^-7 units: no value is near a half.
            for (int y = 0; y < kSize.height; ++y)
              for (int x = 0; x < kSize.width; ++x)
                ASSERT_EQ(static_cast<int>(expected.only().depth.at(x, y)),
                          base + rise_x * x + rise_y * y + factor * slope + units)
                    << x << ' ' << y;
          }
}

TEST(PolygonOffset, OneUnitIsTheSmallestResolvableDifference) {  // piglit polygon-offset
  Grid grid("polygon offset r by bisection");
  for (const DepthFormat format : kDepthFormats) {
    const std::uint32_t middle = flat_depth(grid, format, 0.0f, 0.0f);
    const auto deeper_by = [&](std::uint32_t steps, float z, float units) {
      return flat_depth(grid, format, z, units) >= middle + steps;
    };
    // The smallest difference of z that two stored depths tell: between the first two values of z
    // that store one more each. Vertices snap to 1/256 (D24) or 1/65536 (D16) unit.
    const float limit = 4.0f / static_cast<float>(one(format));
    const float z1 = bisect(0.0f, limit, [&](float z) { return deeper_by(1, z, 0.0f); });
    const float z2 = bisect(0.0f, 2 * limit, [&](float z) { return deeper_by(2, z, 0.0f); });
    const double step = (static_cast<double>(z2) - z1) / 2.0 * one(format);
    EXPECT_NEAR(step, 1.0, format == DepthFormat::d24 ? 1.0 / 256 : 1.0 / 65536) << text(format);
    // The same for units: from one stored depth to the next it takes exactly one.
    const float u1 = bisect(0.0f, 8.0f, [&](float u) { return deeper_by(1, 0.0f, u); });
    const float u2 = bisect(0.0f, 8.0f, [&](float u) { return deeper_by(2, 0.0f, u); });
    EXPECT_NEAR(u2 - u1, 1.0f, format == DepthFormat::d24 ? 1.0f / 256 : 1.0f / 65536)
        << text(format);
    EXPECT_EQ(flat_depth(grid, format, 0.0f, 1.0f), middle + 1);
    EXPECT_EQ(flat_depth(grid, format, 0.0f, -1.0f), middle - 1);
  }
}

TEST(PolygonOffset, TheResultStaysInTheDepthBuffersRange) {  // dEQP result_depth_clamp
  Grid grid("polygon offset clamped results");
  for (const DepthFormat format : kDepthFormats)
    for (const float units : {-3e38f, -1e9f, 1e9f, 3e38f})
      for (const Size size : kSizes) {
        const Expected expected = grid.check(
            "units " + std::to_string(units), Buffers(size, format), [&](Frame& frame, auto&) {
              frame.clear({.depth = 0.5f});
              record_draw(frame, {.state = offset_state({0.0f, units})}, {full_quad()});
            });
        for (const std::uint32_t d : expected.only().depth.to_rows())
          ASSERT_EQ(d, units < 0 ? 0 : one(format));
      }
}
