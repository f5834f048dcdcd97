// The stencil test alone and on two faces. Grids: dEQP stencil.* (functions, operations, masks),
// the Vulkan CTS's pipeline stencil states (8 x 8 x 8 operations x 8 functions for each face),
// piglit's stencil-wrap, stencil-twoside and two-sided-stencil. Oracles: the slow reference for the
// bytes; closed forms for operations, counts for outcomes.
#include <gtest/gtest.h>

#include <algorithm>

#include "every_value.h"
#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

constexpr std::array<int, 8> kRefs{-2, 0, 1, 127, 128, 254, 255, 260};

/// The value after an operation, before the write mask: sums clamped or taken modulo 256.
int operated(StencilOp op, int value, int ref) {
  const std::array<int, 8> results{value,
                                   0,
                                   std::clamp(ref, 0, 255),
                                   std::min(value + 1, 255),
                                   (value + 1) & 255,
                                   std::max(value - 1, 0),
                                   (value - 1) & 255,
                                   value ^ 255};
  return results[static_cast<std::size_t>(op)];
}

std::string number(int n) { return std::to_string(n); }

/// A face that a draw of the other facing must not see.
StencilFace trap() {
  return {.func = CompareFunc::never, .write_mask = 0xa5, .fail = StencilOp::invert};
}

}  // namespace

TEST(StencilState, EveryFunctionComparesEveryValueUnderEveryMask) {
  Grid grid("stencil functions x refs x read masks");
  for (const CompareFunc func : kFuncs)
    for (const int ref : kRefs)
      for (const int mask : {0x00, 0x01, 0x0f, 0x7f, 0x80, 0xaa, 0xff}) {
        const State state{.stencil =
                              StencilState::both({.func = func,
                                                  .read_mask = static_cast<std::uint8_t>(mask),
                                                  .fail = StencilOp::invert,
                                                  .pass = StencilOp::incr_wrap})};
        const std::string name = text(func) + " ref " + number(ref) + " mask " + number(mask);
        const Expected expected =
            grid.check(name, every_value(kEveryValue, DepthFormat::d24), [&](Frame& frame, auto&) {
              record_draw(frame, {.state = state, .stencil_ref = ref}, {full_quad()});
            });
        expect_same(expected.outcomes, counted_outcomes(state, ref, true), name);
      }
}

TEST(StencilState, EveryOperationLeavesItsClosedFormUnderEveryWriteMask) {
  Grid grid("stencil operations x refs x write masks");
  for (const StencilOp op : kOps)
    for (const int ref : kRefs)
      for (const int mask : {0x00, 0x01, 0x0f, 0x7f, 0x80, 0xaa, 0xff}) {
        const State state{.stencil = StencilState::both(
                              {.write_mask = static_cast<std::uint8_t>(mask), .pass = op})};
        const std::string name = text(op) + " ref " + number(ref) + " mask " + number(mask);
        const Buffers before = every_value({16, 16}, DepthFormat::d24);
        const Expected expected = grid.check(name, before, [&](Frame& frame, auto&) {
          record_draw(frame, {.state = state, .stencil_ref = ref}, {full_quad()});
        });
        for (int y = 0; y < 16; ++y)
          for (int x = 0; x < 16; ++x) {
            const int old = before.stencil.at(x, y);
            ASSERT_EQ(expected.only().stencil.at(x, y),
                      (old & ~mask) | (operated(op, old, ref) & mask))
                << name;
          }
      }
}

TEST(StencilState, CountingPastTheEndWrapsOrStays) {  // piglit stencil-wrap
  Grid grid("stencil wrap and saturation");
  for (const StencilOp op :
       {StencilOp::incr, StencilOp::incr_wrap, StencilOp::decr, StencilOp::decr_wrap})
    for (const int start : {0, 1, 100, 254, 255})
      for (const int draws : {1, 2, 255, 256, 300})
        for (const Size size : {Size{1, 1}, Size{7, 5}, Size{63, 65}}) {
          if (size.width == 63 && draws > 2) continue;
          const std::string name = text(op) + " from " + number(start) + " x " + number(draws);
          const Expected expected = grid.check(name, Buffers(size), [&](Frame& frame, auto&) {
            frame.clear({.stencil = start});
            std::vector<glm::vec4> quads;
            for (int i = 0; i < draws; ++i)
              for (const glm::vec4& p : full_quad()) quads.push_back(p);
            record_draw(frame, {.state = {.stencil = StencilState::both({.pass = op})}}, {quads});
          });
          int value = start;
          for (int i = 0; i < draws; ++i) value = operated(op, value, 0);
          for (const std::uint8_t s : expected.only().stencil.to_rows())
            ASSERT_EQ(s, value) << name;
        }
}

TEST(StencilState, EveryFaceStateOfTheVulkanGridActsOnItsFaceOnly) {
  Grid grid("stencil states (8^4 a face)");
  for (const bool front : {true, false})
    for (const CompareFunc func : kFuncs)
      for (const StencilOp fail : kOps)
        for (const StencilOp depth_fail : kOps)
          for (const StencilOp pass : kOps) {
            const StencilFace face{
                .func = func, .fail = fail, .depth_fail = depth_fail, .pass = pass};
            State state{.depth = DepthState{CompareFunc::less, false},
                        .stencil = StencilState{trap(), trap()}};
            (front ? state.stencil->front : state.stencil->back) = face;
            const std::string name = std::string(front ? "front " : "back ") + text(func) + " " +
                                     text(fail) + " " + text(depth_fail) + " " + text(pass);
            const Expected expected = grid.check(
                name, every_value(kEveryValue, DepthFormat::d24), [&](Frame& frame, auto&) {
                  record_draw(frame, {.state = state, .stencil_ref = 128},
                              {front ? full_quad() : reversed(full_quad())});
                });
            expect_same(expected.outcomes, counted_outcomes(state, 128, front), name);
          }
}

TEST(StencilState, TwoFacesKeepTheirOwnStatesInOneDraw) {  // piglit stencil-twoside
  Grid grid("stencil two-sided");
  Random random(7);
  const auto mask = [&random] { return static_cast<std::uint8_t>(random.integer(0, 255)); };
  const auto op = [&random] { return kOps[static_cast<std::size_t>(random.integer(0, 7))]; };
  const auto face = [&] {
    StencilFace f{.func = kFuncs[static_cast<std::size_t>(random.integer(1, 7))]};
    f.read_mask = mask();
    f.write_mask = mask();
    f.fail = op();
    f.depth_fail = op();
    f.pass = op();
    return f;
  };
  for (int round = 0; round < 150; ++round) {
    const State state{
        .depth = DepthState{CompareFunc::less_equal, round % 2 == 0},
        .stencil = StencilState{face(), face()},
        .front_face = round % 3 ? FrontFace::ccw : FrontFace::cw,
    };
    const int ref = random.integer(-2, 260);
    std::array<glm::vec2, 12> corners;
    for (glm::vec2& c : corners) c = {random.real(-0.2f, 1.2f), random.real(-0.2f, 1.2f)};
    for (const Size size : kSizes)
      grid.check(
          "round " + number(round) + " " + text(size),
          every_value(size, round % 5 ? DepthFormat::d24 : DepthFormat::d16),
          [&](Frame& frame, auto&) {
            // Triangles of random winding over each other, in one draw.
            std::vector<glm::vec4> positions;
            for (const glm::vec2& c : corners)
              positions.push_back(at_window(c.x * static_cast<float>(size.width),
                                            c.y * static_cast<float>(size.height), size));
            record_draw(frame, {.state = state, .stencil_ref = ref}, {positions});
          },
          round % 25 ? Runs::each_isa : Runs::every_variant);
  }
}

TEST(StencilState, FrontUpAndBackDownLeaveWhatTheirOrderSays) {  // piglit two-sided-stencil
  Grid grid("stencil two-sided counts");
  for (const Size size : kSizes)
    for (int fronts = 0; fronts < 4; ++fronts)
      for (int backs = 0; backs < 4; ++backs) {
        const State state{.stencil = StencilState{{.pass = StencilOp::incr_wrap},
                                                  {.pass = StencilOp::decr_wrap}}};
        const std::string name = number(fronts) + " fronts " + number(backs) + " backs";
        const Expected expected = grid.check(name, Buffers(size), [&](Frame& frame, auto&) {
          std::vector<glm::vec4> positions;
          for (int i = 0; i < fronts + backs; ++i)
            for (const glm::vec4& p : i < fronts ? full_quad() : reversed(full_quad()))
              positions.push_back(p);
          record_draw(frame, {.state = state}, {positions});
        });
        for (const std::uint8_t s : expected.only().stencil.to_rows())
          ASSERT_EQ(s, (fronts - backs) & 255) << name;
      }
}
