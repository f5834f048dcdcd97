#include "raster/execute.h"

#include <gtest/gtest.h>

#include <array>

#include "random_frames.h"

using namespace gnomon::raster;

namespace {

const std::array<std::uint32_t, 6> kQuadIndices{0, 1, 2, 0, 2, 3};

}  // namespace

TEST(Execute, AFullScreenQuadCoversEveryPixelOnce) {  // oracle: closed form
  ColorBuffer color(100, 70);
  DepthBuffer depth(100, 70);
  StencilBuffer stencil(100, 70);
  const std::array<glm::vec4, 4> quad{
      glm::vec4{-1, -1, 0, 1}, {1, -1, 0, 1}, {1, 1, 0, 1}, {-1, 1, 0, 1}};
  Frame frame;
  frame.begin_pass("quad", {&color, &depth, &stencil});
  StencilFace count;
  count.pass = StencilOp::incr_wrap;
  frame.draw({.state = {.depth = DepthState{}, .stencil = StencilState::both(count)},
              .mesh = {.positions = quad, .indices = kQuadIndices},
              .shading = Flat{.color = {1.0f, 0.5f, 0.0f, 1.0f}, .texture = {}}});
  execute(frame);
  for (int y = 0; y < 70; ++y)
    for (int x = 0; x < 100; ++x) {
      EXPECT_EQ(stencil.at(x, y), 1);
      EXPECT_EQ(depth.at(x, y), 0x800000u);
      EXPECT_EQ(color.rgba8().at(x, y), (Rgba8{255, 128, 0, 255}));
    }
}

TEST(Execute, RunsOnlyTheFirstCommands) {  // oracle: closed form
  StencilBuffer stencil(3, 3);
  Frame frame;
  frame.begin_pass("clears", {.stencil = &stencil});
  frame.clear({.stencil = 1});
  frame.clear({.stencil = 2});
  execute(frame, {.commands = 1});
  EXPECT_EQ(stencil.at(2, 2), 1);
  execute(frame);
  EXPECT_EQ(stencil.at(2, 2), 2);
}

// Oracle: closed form. Were the first frame's ranges still believed, all of a block would pass.
TEST(DepthRanges, AreForgottenWhenDepthsAreWrittenByHand) {
  constexpr int kSize = 70;
  DepthBuffer depth(kSize, kSize);
  StencilBuffer stencil(kSize, kSize);
  const std::array<glm::vec4, 4> quad{
      glm::vec4{-1, -1, 0, 1}, {1, -1, 0, 1}, {1, 1, 0, 1}, {-1, 1, 0, 1}};
  StencilFace count;
  count.pass = StencilOp::incr_wrap;
  Frame frame;
  frame.begin_pass("counted", {.depth = &depth, .stencil = &stencil});
  frame.draw({.state = {.depth = DepthState{.write = false},
                        .stencil = StencilState::both(count),
                        .color = ColorState::off()},
              .mesh = {.positions = quad, .indices = kQuadIndices}});
  execute(frame);
  depth.plane().at(5, 5) = depth.plane().at(66, 3) = 1;
  execute(frame);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const bool nearer = (x == 5 && y == 5) || (x == 66 && y == 3);
      EXPECT_EQ(stencil.at(x, y), nearer ? 1 : 2) << x << ", " << y;
    }
}

// Oracle: executions with memory of their own.
TEST(ExecuteMemory, LeavesNothingOfAFrameInTheNext) {
  ExecuteMemory memory;
  for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    const int width = 40 + static_cast<int>(seed % 3) * 50;
    gnomon::random_frames::Targets reused(width, 70, ColorFormat::rgba8, DepthFormat::d24);
    gnomon::random_frames::Targets fresh(width, 70, ColorFormat::rgba8, DepthFormat::d24);
    execute(gnomon::random_frames::random_frame(seed, 20, reused),
            {.threads = 2, .memory = &memory});
    execute(gnomon::random_frames::random_frame(seed, 20, fresh));
    EXPECT_EQ(reused.bytes(), fresh.bytes()) << "seed " << seed;
  }
}
