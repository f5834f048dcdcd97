// Depth clamp. Grids: piglit depth_clamp and depth-clamp-range. Oracles: the slow reference for the
// bytes; for constant depths on eighths, the rational rounded to nearest (a half upwards), after
// the offset clamped to the range.
#include <gtest/gtest.h>

#include <algorithm>

#include "grid.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;

namespace {

/// Near and far in eighths, in both orders and of no width.
constexpr std::array<std::array<int, 2>, 8> kRanges{
    {{0, 8}, {8, 0}, {2, 6}, {6, 2}, {4, 4}, {0, 0}, {8, 8}, {1, 3}}};

std::int64_t one(DepthFormat format) { return format == DepthFormat::d24 ? 0xffffff : 0xffff; }

/// n / 128 of the largest depth, to nearest, a half upwards.
std::int64_t rounded(std::int64_t n, DepthFormat format) {
  const std::int64_t twice = 2 * n * one(format) + 128;
  return twice >= 0 ? twice / 256 : -((-twice + 255) / 256);
}

State clamping(const std::array<int, 2>& range, bool clamp, int units) {
  State state{
      .depth = DepthState{CompareFunc::always, true},
      .polygon_offset = PolygonOffset{0.0f, static_cast<float>(units)},
      .depth_range = {static_cast<float>(range[0]) / 8.0f, static_cast<float>(range[1]) / 8.0f}};
  state.depth_clamp = clamp;
  return state;
}

}  // namespace

TEST(DepthClamp, EveryDepthAndOffsetEndsInTheRange) {
  Grid grid("depth clamp: z x range x units");
  constexpr std::uint32_t kBefore = 1234;
  for (const DepthFormat format : kDepthFormats)
    for (const auto& range : kRanges)
      for (int z = -24; z <= 24; z += 2)
        for (const int units : {0, -3, 3, -30000000, 30000000})
          for (const bool clamp : {false, true}) {
            Buffers before({7, 5}, format);
            for (int y = 0; y < 5; ++y)
              for (int x = 0; x < 7; ++x) before.depth.plane().at(x, y) = kBefore;
            const std::string name = text(format) + " z " + std::to_string(z) + " units " +
                                     std::to_string(units) + (clamp ? " clamped" : " clipped");
            const Expected expected = grid.check(name, before, [&](Frame& frame, auto&) {
              record_draw(frame, {.state = clamping(range, clamp, units)},
                          {full_quad(static_cast<float>(z) / 8.0f)});
            });
            const std::int64_t in_128ths = 8 * (range[0] + range[1]) + z * (range[1] - range[0]);
            const std::int64_t depth = rounded(in_128ths, format) + units;
            const auto [near, far] = std::minmax(range[0], range[1]);
            const std::int64_t wanted =
                clamp ? std::clamp(depth, rounded(16 * near, format), rounded(16 * far, format))
                : z < -8 || z > 8 ? kBefore
                                  : std::clamp<std::int64_t>(depth, 0, one(format));
            for (const std::uint32_t d : expected.only().depth.to_rows())
              ASSERT_EQ(d, wanted) << name << " range " << range[0] << ' ' << range[1];
          }
}

TEST(DepthClamp, OfSlopedTrianglesEqualsTheReferenceAtEverySize) {
  Grid grid("depth clamp: slopes");
  for (const DepthFormat format : kDepthFormats)
    for (const auto& range : kRanges)
      for (const CompareFunc func : kFuncs)
        for (const float steep : {0.5f, 4.0f, 1e6f, 1e18f})
          for (const Size size : {Size{1, 1}, Size{7, 5}, Size{63, 65}}) {
            State state = clamping(range, true, 2);
            state.depth = DepthState{func, true};
            grid.check("steep " + std::to_string(steep), Buffers(size, format),
                       [&](Frame& frame, auto&) {
                         frame.clear({.depth = 0.5f});
                         record_draw(frame, {.state = state},
                                     {{{-1, -1, -steep, 1},
                                       {3, -1, steep, 1},
                                       {-1, 3, 0.5f, 1},
                                       {-2, -2, steep, 2},
                                       {1, -1, -steep, 0},
                                       {0, 2, 0, 1}}});
                       });
          }
}

TEST(DepthClamp, WhatLiesBehindTheEyeIsCutAllTheSame) {
  Grid grid("depth clamp: behind the eye");
  for (const float w : {-1.0f, 0.0f})
    for (const Size size : kSizes) {
      const Expected expected = grid.check("w", Buffers(size), [&](Frame& frame, auto&) {
        record_draw(frame, {.state = clamping({0, 8}, true, 0)},
                    {{{-1, -1, 0, w}, {3, -1, 0, w}, {-1, 3, 0, w}}});
      });
      EXPECT_EQ(expected.outcomes.pass, 0u);
    }
}
