#include "raster/history.h"

#include <gtest/gtest.h>

#include <array>

#include "random_frames.h"
#include "raster/draw_fates.h"
#include "reference/reference.h"
#include "small_frames.h"

using namespace gnomon;
using namespace gnomon::raster;

namespace {

constexpr int kWidth = 70, kHeight = 66;

struct Stored {
  glm::vec4 color;
  std::uint32_t depth;
  std::uint8_t stencil;
};

Stored stored(const random_frames::Targets& targets, int x, int y) {
  return {targets.color.at(x, y), targets.depth.at(x, y), targets.stencil.at(x, y)};
}

/// A float that is not a number equals another one.
bool same_color(const glm::vec4& a, const glm::vec4& b) {
  for (int c = 0; c < 4; ++c)
    if (!(a[c] == b[c] || (a[c] != a[c] && b[c] != b[c]))) return false;
  return true;
}

void expect_same(const PixelValues& told, const Stored& is, const std::string& where) {
  EXPECT_TRUE(same_color(told.color, is.color)) << where;
  EXPECT_EQ(told.depth, is.depth) << where;
  EXPECT_EQ(told.stencil, is.stencil) << where;
}

random_frames::Targets targets_of(std::uint32_t seed) {
  return {kWidth, kHeight, seed % 3 ? ColorFormat::rgba8 : ColorFormat::rgba32f,
          seed % 2 ? DepthFormat::d24 : DepthFormat::d16};
}

}  // namespace

// Oracle: the buffers after each command of the same frame, executed one command after the other.
TEST(History, TellsWhatEveryCommandLeftAtThePixel) {
  constexpr std::array<std::array<int, 2>, 6> kPixels{
      {{0, 0}, {63, 63}, {64, 64}, {69, 65}, {35, 33}, {8, 50}}};
  std::size_t touched = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed)
    for (const auto& [x, y] : kPixels) {
      random_frames::Targets told = targets_of(seed), is = targets_of(seed);
      const PixelHistory history = raster::history(random_frame(seed, 30, told), x, y);
      const Frame frame = random_frame(seed, 30, is);
      auto next = history.commands.begin();
      for (std::size_t command = 0; command < frame.command_count(); ++command) {
        const Stored before = stored(is, x, y);
        execute(frame, {.first_command = command, .commands = command + 1});
        const std::string where = "seed " + std::to_string(seed) + ", command " +
                                  std::to_string(command) + ", pixel " + std::to_string(x) + " " +
                                  std::to_string(y);
        if (next == history.commands.end() || next->command != command) {
          const Stored after = stored(is, x, y);
          EXPECT_TRUE(same_color(before.color, after.color)) << where;
          EXPECT_EQ(before.depth, after.depth) << where;
          EXPECT_EQ(before.stencil, after.stencil) << where;
          continue;
        }
        ++touched;
        expect_same(next->before, before, where);
        expect_same(next->after, stored(is, x, y), where);
        ++next;
      }
      EXPECT_TRUE(next == history.commands.end());
      EXPECT_EQ(told.bytes(), is.bytes()) << "seed " << seed;
    }
  EXPECT_GT(touched, 1000u);
}

// Oracle: closed form.
TEST(History, GoesFromFragmentToFragment) {
  StencilBuffer stencil(4, 4);
  DepthBuffer depth(4, 4);
  Frame frame;
  frame.begin_pass("count", {.depth = &depth, .stencil = &stencil});
  frame.clear({.depth = 0.5f, .stencil = 7});
  State state = small_frames::signed_counting();
  state.depth = DepthState{.func = CompareFunc::less, .write = false};
  state.stencil->front.depth_fail = StencilOp::invert;
  const auto at = [](double x, double y, double z) {
    return small_frames::at_window(x, y, 4, 4, z);
  };
  small_frames::draw_positions(frame, state,
                               {at(-1, -1, 0.25), at(9, -1, 0.25), at(-1, 9, 0.25),  // front, near
                                at(-1, -1, 0.25), at(-1, 9, 0.25), at(9, -1, 0.25),  // back, near
                                at(-1, -1, 0.75), at(9, -1, 0.75), at(-1, 9, 0.75)});  // front, far
  const PixelHistory told = history(frame, 1, 2);
  ASSERT_EQ(told.commands.size(), 2u);
  EXPECT_TRUE(told.commands[0].fragments.empty());
  EXPECT_EQ(told.commands[0].after.stencil, 7);
  const auto& fragments = told.commands[1].fragments;
  ASSERT_EQ(fragments.size(), 3u);
  EXPECT_EQ(fragments[0].outcome, Outcome::pass);
  EXPECT_EQ(fragments[0].stencil_op, StencilOp::incr_wrap);
  EXPECT_EQ(fragments[0].after.stencil, 8);
  EXPECT_EQ(fragments[0].depth, 0x400000u);
  EXPECT_FALSE(fragments[1].front_facing);
  EXPECT_EQ(fragments[1].triangle, 1u);
  EXPECT_EQ(fragments[1].after.stencil, 7);
  EXPECT_EQ(fragments[2].outcome, Outcome::depth_fail);
  EXPECT_EQ(fragments[2].after.stencil, 0xf8);
  EXPECT_EQ(fragments[2].after.depth, 0x800000u);
}

// Oracle: closed form. The map's pass is no part of the picture's history but must have been drawn.
TEST(History, LooksUpWhatWasDrawnBefore) {
  DepthBuffer map(8, 8);
  ColorBuffer color(4, 4);
  Frame frame;
  frame.begin_pass("map", {.depth = &map});
  frame.clear({.depth = 0.25f});
  frame.begin_pass("picture", {.color = &color});
  const auto kept = std::make_shared<std::array<glm::vec4, 3>>(
      std::array<glm::vec4, 3>{glm::vec4{-1, -1, 0.5f, 1}, {3, -1, 0.5f, 1}, {-1, 3, 0.5f, 1}});
  static constexpr std::array<std::uint32_t, 3> kIndices{0, 1, 2};
  frame.keep(kept);
  Flat flat;
  flat.depth_lookup = DepthLookup{.map = &map};
  frame.draw({.mesh = {.positions = *kept, .indices = kIndices}, .shading = flat});
  const PixelHistory told = history(frame, 3, 3);
  ASSERT_EQ(told.commands.size(), 1u);
  EXPECT_EQ(told.commands[0].command, 1u);
  EXPECT_EQ(told.commands[0].after.color, (glm::vec4{0.0f, 0.0f, 0.0f, 1.0f}));
  // Asked about the map's own pass.
  EXPECT_EQ(history(frame, 7, 7, {.pass = 0}).commands.at(0).after.depth, 0x400000u);
}

// Oracle: the buffers after each command. The passes' targets are linked through each other: the
// second one shares nothing with the last, and decides what is drawn there.
TEST(History, FollowsPassesThatAreLinkedThroughOthers) {
  for (std::uint32_t seed = 100; seed < 130; ++seed) {
    const auto record = [seed](random_frames::Targets& a, random_frames::Targets& b) {
      Frame frame;
      const std::array<Targets, 4> targets{
          Targets{&b.color, &a.depth, &b.stencil}, Targets{&b.color, &b.depth, &b.stencil},
          Targets{&b.color, &a.depth, &b.stencil}, Targets{&a.color, &a.depth, nullptr}};
      for (std::uint32_t pass = 0; pass < 3; ++pass)
        random_frames::record_pass(frame, seed + 1000 * pass, 8, targets[pass]);
      frame.begin_pass("last", targets[3]);
      State state;
      state.depth = DepthState{.func = CompareFunc::less_equal};
      small_frames::draw_positions(frame, state,
                                   {{-1, -1, 0.2f, 1}, {3, -1, 0.2f, 1}, {-1, 3, 0.2f, 1}});
      return frame;
    };
    random_frames::Targets a = targets_of(seed), b = targets_of(seed);
    const PixelHistory told = history(record(a, b), 20, 30);
    random_frames::Targets c = targets_of(seed), d = targets_of(seed);
    const Frame frame = record(c, d);
    std::size_t done = 0;
    for (const CommandRecord& command : told.commands) {
      execute(frame, {.first_command = done, .commands = command.command + 1});
      done = command.command + 1;
      EXPECT_EQ(command.after.depth, c.depth.at(20, 30))
          << "seed " << seed << ", command " << command.command;
    }
  }
}

TEST(History, StopsBeforeACommand) {  // oracle: closed form
  StencilBuffer stencil(3, 3);
  Frame frame;
  frame.begin_pass("clears", {.stencil = &stencil});
  frame.clear({.stencil = 1});
  frame.clear({.stencil = 2});
  EXPECT_EQ(history(frame, 0, 0, {.commands = 1}).commands.size(), 1u);
  EXPECT_EQ(stencil.at(2, 2), 1);
}

TEST(History, RefusesAPixelThatIsNotThere) {  // oracle: closed form
  StencilBuffer stencil(3, 3);
  Frame frame;
  EXPECT_THROW(history(frame, 0, 0), std::invalid_argument);
  frame.begin_pass("nothing", {.stencil = &stencil});
  EXPECT_THROW(history(frame, 3, 0), std::invalid_argument);
  EXPECT_THROW(history(frame, 0, -1), std::invalid_argument);
  EXPECT_THROW(history(frame, 0, 0, {.pass = 1}), std::invalid_argument);
  EXPECT_TRUE(history(frame, 2, 2).commands.empty());
}

// Oracle: the outcomes that the reference renderer counted, of all pixels together.
TEST(DrawFates, AddUpToTheReferencesOutcomes) {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    random_frames::Targets is = targets_of(seed), expected = targets_of(seed);
    const reference::Outcomes outcomes = reference::execute(random_frame(seed, 20, expected));
    const Frame frame = random_frame(seed, 20, is);
    DrawFates fates(kWidth, kHeight);
    std::size_t number = 0;
    for (const Pass& pass : frame.passes())
      for (const Command& command : pass.commands) {
        add_fates(command, pass.targets, fates);
        execute(frame, {.first_command = number, .commands = number + 1});
        ++number;
      }
    const auto sum = [](const std::vector<std::uint16_t>& counts) {
      std::uint64_t total = 0;
      for (const std::uint16_t count : counts) total += count;
      return total;
    };
    EXPECT_EQ(sum(fates.stencil_failed), outcomes.stencil_fail) << "seed " << seed;
    EXPECT_EQ(sum(fates.depth_failed), outcomes.depth_fail) << "seed " << seed;
    EXPECT_EQ(sum(fates.passed), outcomes.pass) << "seed " << seed;
  }
}

// Oracle: closed form.
TEST(DrawFates, TellWhereTheStencilIsCountedUpAndDown) {
  StencilBuffer stencil(4, 4);
  Frame frame;
  frame.begin_pass("count", {.stencil = &stencil});
  const auto at = [](double x, double y) { return small_frames::at_window(x, y, 4, 4); };
  small_frames::draw_positions(frame, small_frames::signed_counting(),
                               {at(-1, -1), at(9, -1), at(-1, 9), at(0, 0), at(0, 2), at(2, 0)});
  DrawFates fates(4, 4);
  add_fates(frame.passes()[0].commands[0], frame.passes()[0].targets, fates);
  EXPECT_EQ(fates.raised, std::vector<std::uint16_t>(16, 1));
  EXPECT_EQ(fates.lowered[0], 1);
  EXPECT_EQ(fates.lowered[15], 0);
  EXPECT_EQ(stencil.at(0, 0), 0);
}
