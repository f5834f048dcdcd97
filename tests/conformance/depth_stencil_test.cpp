// Stencil and depth state together. Grids: dEQP-GLES3.functional.depth_stencil (functions 9 x 9,
// operations 8^3, write masks, 25 x 10 random states). Oracles: the slow reference for the bytes;
// for how many fragments end at which outcome, counting over all 256 stencil values and three depth
// relations, which the target holds.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>

#include "every_value.h"
#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

/// A face that leaves another value for each outcome.
StencilFace telling(CompareFunc func) {
  return {.func = func,
          .fail = StencilOp::invert,
          .depth_fail = StencilOp::incr_wrap,
          .pass = StencilOp::replace};
}

StencilFace random_face(Random& random) {
  StencilFace face;
  face.func = kFuncs[static_cast<std::size_t>(random.integer(0, 7))];
  // 32-bit masks, as an application passes them; the low 8 bits count.
  const auto mask = [&random] {
    return static_cast<std::uint8_t>(static_cast<unsigned>(
        random.integer(std::numeric_limits<int>::min(), std::numeric_limits<int>::max())));
  };
  face.read_mask = mask();
  face.write_mask = mask();
  face.fail = kOps[static_cast<std::size_t>(random.integer(0, 7))];
  face.depth_fail = kOps[static_cast<std::size_t>(random.integer(0, 7))];
  face.pass = kOps[static_cast<std::size_t>(random.integer(0, 7))];
  return face;
}

/// Overlapping quads of both windings at depths around the middle, with one state.
void record_quads(Frame& frame, const State& state, int ref, Size size, std::uint32_t seed) {
  Random random(seed);
  for (int i = 0; i < 4; ++i) {
    const double x0 = random.integer(-8, size.width), y0 = random.integer(-8, size.height);
    const double x1 = x0 + random.integer(1, size.width + 8),
                 y1 = y0 + random.integer(1, size.height + 8);
    std::vector<glm::vec4> corners =
        quad(x0, y0, x1, y1, size, 0.5 + random.integer(-1, 1) / 16777216.0);
    if (i % 2) corners = reversed(corners);
    const auto shade = static_cast<float>(i + 1) / 5.0f;
    record_draw(frame,
                {.state = state, .shading = Flat{{shade, 1 - shade, 0.5f, 1}}, .stencil_ref = ref},
                {corners});
  }
}

}  // namespace

TEST(DepthStencil, EveryPairOfFunctionsEndsEachFragmentWhereItMust) {
  Grid grid("depth_stencil functions (9 x 9)");
  for (const DepthFormat format : kDepthFormats)
    for (std::size_t s = 0; s <= kFuncs.size(); ++s)
      for (std::size_t d = 0; d <= kFuncs.size(); ++d) {
        State state;
        if (s < kFuncs.size()) state.stencil = StencilState::both(telling(kFuncs[s]));
        if (d < kFuncs.size()) state.depth = DepthState{kFuncs[d], true};
        const std::string name =
            text(format) + " stencil " + std::to_string(s) + " depth " + std::to_string(d);
        const Buffers every = every_value(kEveryValue, format);
        const auto record = [&](Frame& frame, Buffers&) {
          record_draw(frame, {.state = state, .stencil_ref = 100}, {full_quad()});
        };
        const Expected expected = grid.check(name, every, record);
        expect_same(expected.outcomes, counted_outcomes(state, 100, true), name);

        for (const Size size : kSizes) {
          const Buffers buffers = every_value(size, format);
          grid.check(name + " " + text(size), buffers, [&](Frame& frame, Buffers&) {
            record_quads(frame, state, 100, size, static_cast<std::uint32_t>(9 * s + d));
          });
        }
      }
}

TEST(DepthStencil, EveryTripleOfOperationsIsReachedOnEveryValue) {
  Grid grid("depth_stencil operations (8^3)");
  for (const StencilOp fail : kOps)
    for (const StencilOp depth_fail : kOps)
      for (const StencilOp pass : kOps) {
        StencilFace face{
            .func = CompareFunc::less_equal, .fail = fail, .depth_fail = depth_fail, .pass = pass};
        const State state{.depth = DepthState{CompareFunc::less, true},
                          .stencil = StencilState::both(face)};
        const std::string name = text(fail) + " " + text(depth_fail) + " " + text(pass);
        const Buffers every = every_value(kEveryValue, DepthFormat::d24);
        const Expected expected = grid.check(name, every, [&](Frame& frame, Buffers&) {
          record_draw(frame, {.state = state, .stencil_ref = 77}, {full_quad()});
        });
        expect_same(expected.outcomes, counted_outcomes(state, 77, true), name);
        EXPECT_GT(expected.outcomes.stencil_fail, 0u) << name;
        EXPECT_GT(expected.outcomes.depth_fail, 0u) << name;
        EXPECT_GT(expected.outcomes.pass, 0u) << name;
      }
}

TEST(DepthStencil, EveryWriteMaskKeepsItsBits) {
  Grid grid("depth_stencil write masks");
  for (int mask = 0; mask < 256; ++mask)
    for (const bool depth_write : {false, true}) {
      const StencilFace face{.write_mask = static_cast<std::uint8_t>(mask),
                             .depth_fail = StencilOp::invert,
                             .pass = StencilOp::invert};
      const std::string name = "mask " + std::to_string(mask);
      const Buffers every =
          every_value(kEveryValue, depth_write ? DepthFormat::d24 : DepthFormat::d16);
      const Expected expected = grid.check(name, every, [&](Frame& frame, Buffers&) {
        record_draw(frame,
                    {.state = {.depth = DepthState{CompareFunc::less, depth_write},
                               .stencil = StencilState::both(face)}},
                    {full_quad()});
      });
      for (int y = 0; y < kEveryValue.height; ++y)
        for (int x = 0; x < kEveryValue.width; ++x) {
          ASSERT_EQ(expected.only().stencil.at(x, y), every.stencil.at(x, y) ^ mask) << name;
          const bool nearer = every.depth.at(x, y) > middle_depth(every.depth.format());
          ASSERT_EQ(expected.only().depth.at(x, y) != every.depth.at(x, y), nearer && depth_write);
        }
    }
}

TEST(DepthStencil, RandomStatesWithReferencesAndMasksOutOfRange) {
  Grid grid("depth_stencil random states (25 x 10)");
  std::array<std::uint64_t, 3> reached{};
  for (std::uint32_t group = 0; group < 25; ++group) {
    Random random(1000 + group);
    for (int index = 0; index < 10; ++index) {
      State state;
      if (random.chance(0.9f))
        state.stencil = StencilState{random_face(random), random_face(random)};
      if (random.chance(0.9f))
        state.depth =
            DepthState{kFuncs[static_cast<std::size_t>(random.integer(0, 7))], random.chance(0.7f)};
      const int ref = random.integer(-2, 260);
      const std::string name = std::to_string(group) + "." + std::to_string(index);
      const DepthFormat format = index % 2 ? DepthFormat::d16 : DepthFormat::d24;
      const Buffers every = every_value(kEveryValue, format);
      for (const bool front : {true, false}) {
        const Expected expected = grid.check(name, every, [&](Frame& frame, Buffers&) {
          record_draw(frame, {.state = state, .stencil_ref = ref},
                      {front ? full_quad() : reversed(full_quad())});
        });
        const gnomon::reference::Outcomes wanted = counted_outcomes(state, ref, front);
        expect_same(expected.outcomes, wanted, name);
        reached[0] += wanted.stencil_fail > 0;
        reached[1] += wanted.depth_fail > 0;
        reached[2] += wanted.pass > 0;
      }
      for (const Size size : kSizes) {
        const Buffers buffers = every_value(size, format);
        grid.check(
            name + " " + text(size), buffers,
            [&](Frame& frame, Buffers&) {
              record_quads(frame, state, ref, size, 10 * group + static_cast<std::uint32_t>(index));
            },
            index == 0 ? Runs::every_variant : Runs::each_isa);
      }
    }
  }
  for (const std::uint64_t states : reached) EXPECT_GT(states, 200u);
}
