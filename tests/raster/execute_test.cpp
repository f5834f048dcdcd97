#include "raster/execute.h"

#include <gtest/gtest.h>

#include <array>

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
