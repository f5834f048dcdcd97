// Depth test and write, and the depth range. Grids: dEQP depth.cmp_* and
// depth_range.{write,compare} with reversed and zero-width ranges (one outside [0, 1] is misuse).
// Oracles: the slow reference for the bytes; counts for outcomes; for constant depths on eighths of
// the range, the rational rounded to nearest, a half upwards.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "every_value.h"
#include "grid.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;

namespace {

/// Depth ranges in eighths.
struct Range {
  int near, far;
};
constexpr std::array<Range, 12> kRanges{{{0, 8},
                                         {8, 0},
                                         {0, 4},
                                         {4, 8},
                                         {2, 6},
                                         {6, 2},
                                         {3, 5},
                                         {0, 0},
                                         {8, 8},
                                         {4, 4},
                                         {3, 3},
                                         {5, 1}}};

DepthRange as_state(const Range& range) {
  return {static_cast<float>(range.near) / 8.0f, static_cast<float>(range.far) / 8.0f};
}

/// What z_ndc = z / 8 is stored as.
std::uint32_t stored(const Range& range, int z, DepthFormat format) {
  const std::int64_t near = range.near, far = range.far;
  const std::int64_t in_128ths = 8 * (near + far) + z * (far - near);
  const std::int64_t one = format == DepthFormat::d24 ? 0xffffff : 0xffff;
  return static_cast<std::uint32_t>((2 * in_128ths * one + 128) / 256);
}

std::string text(const Range& range) {
  return "[" + std::to_string(range.near) + ", " + std::to_string(range.far) + "] / 8";
}

}  // namespace

TEST(DepthState, EveryFunctionPassesItsRelationsAndWritesIfAsked) {
  Grid grid("depth functions x write");
  for (const DepthFormat format : kDepthFormats)
    for (const CompareFunc func : kFuncs)
      for (const bool write : {false, true})
        for (const Size size : {Size{1, 1}, Size{7, 5}, kEveryValue, Size{63, 65}, Size{130, 70}}) {
          const State state{.depth = DepthState{func, write}};
          const Buffers before = every_value(size, format);
          const std::string name = gnomon::conformance::text(func) + (write ? " write" : " keep");
          const Expected expected = grid.check(
              name, before,
              [&](Frame& frame, auto&) { record_draw(frame, {.state = state}, {full_quad()}); },
              Runs::every_variant);
          if (size.width == kEveryValue.width)
            expect_same(expected.outcomes, counted_outcomes(state, 0, true), name);
          for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
              const std::uint32_t old = before.depth.at(x, y), z = middle_depth(format);
              ASSERT_EQ(expected.only().depth.at(x, y), write && accepts(func, z, old) ? z : old);
            }
        }
}

TEST(DepthState, WithoutTheTestNothingIsWritten) {
  Grid grid("depth test off");
  for (const DepthFormat format : kDepthFormats)
    for (const Size size : kSizes) {
      const Buffers before = every_value(size, format);
      const Expected expected = grid.check("off", before, [&](Frame& frame, auto&) {
        record_draw(frame, {.state = {.stencil = StencilState::both({.pass = StencilOp::invert})}},
                    {full_quad(-0.5f)});
      });
      EXPECT_EQ(expected.only().depth.to_rows(), before.depth.to_rows());
      EXPECT_EQ(expected.outcomes.pass, static_cast<std::uint64_t>(size.width) * size.height);
    }
}

TEST(DepthRange, MapsEveryDepthToTheRoundedRational) {  // dEQP depth_range.write
  Grid grid("depth range write");
  for (const DepthFormat format : kDepthFormats)
    for (const Range& range : kRanges)
      for (int z = -8; z <= 8; ++z)
        for (const bool clamp : {false, true}) {
          const std::string name = text(range) + " z " + std::to_string(z) + " / 8";
          State state{.depth = DepthState{CompareFunc::always, true},
                      .depth_range = as_state(range)};
          state.depth_clamp = clamp;
          const Expected expected =
              grid.check(name, Buffers({7, 5}, format), [&](Frame& frame, auto&) {
                record_draw(frame, {.state = state}, {full_quad(static_cast<float>(z) / 8.0f)});
              });
          for (const std::uint32_t d : expected.only().depth.to_rows())
            ASSERT_EQ(d, stored(range, z, format)) << name;
        }
}

TEST(DepthRange, ComparesWhatItMapped) {  // dEQP depth_range.compare
  Grid grid("depth range compare");
  for (const DepthFormat format : kDepthFormats)
    for (const Range& range : kRanges)
      for (const CompareFunc func : kFuncs)
        for (int z = -8; z <= 8; z += 4) {
          const std::string name = text(range) + " " + gnomon::conformance::text(func) + " z " +
                                   std::to_string(z) + " / 8";
          const State state{.depth = DepthState{func, false},
                            .stencil = StencilState::both({.pass = StencilOp::invert}),
                            .depth_range = as_state(range)};
          const Expected expected =
              grid.check(name, Buffers({7, 5}, format), [&](Frame& frame, auto&) {
                frame.clear({.depth = 0.5f});
                record_draw(frame, {.state = state}, {full_quad(static_cast<float>(z) / 8.0f)});
              });
          // 0.5 is cleared to the even one of its two nearest; the larger of them, as drawn.
          const bool passes = accepts(func, stored(range, z, format), middle_depth(format));
          for (const std::uint8_t s : expected.only().stencil.to_rows())
            ASSERT_EQ(s, passes ? 255 : 0) << name;
        }
}

TEST(DepthRange, OfSlopedTrianglesEqualsTheReferenceAtEverySize) {
  Grid grid("depth range of slopes");
  for (const DepthFormat format : kDepthFormats)
    for (const Range& range : kRanges)
      for (const Size size : kSizes)
        for (const bool clamp : {false, true}) {
          State state{.depth = DepthState{CompareFunc::less_equal, true},
                      .depth_range = as_state(range)};
          state.depth_clamp = clamp;
          grid.check(text(range) + " " + gnomon::conformance::text(size), Buffers(size, format),
                     [&](Frame& frame, auto&) {
                       record_draw(frame, {.state = state},
                                   {{{-1, -1, -1.5f, 1},
                                     {1, -1, 0.25f, 1},
                                     {1, 1, 1.5f, 1},
                                     {-2, -1, 1, 2},
                                     {1, -1, -0.75f, 1},
                                     {-1, 3, 0.5f, 1}}});
                     });
        }
}

TEST(DepthRange, OutsideZeroToOneIsMisuse) {
  Buffers buffers({2, 2});
  Frame frame;
  frame.begin_pass("range", buffers.all());
  for (const DepthRange& range :
       {DepthRange{-0.125f, 1.0f}, {0.0f, 1.125f}, {2.0f, 0.0f}, {0.0f, std::nanf("")}})
    EXPECT_THROW(record_draw(frame, {.state = {.depth_range = range}}, {full_quad()}),
                 std::invalid_argument);
}
