#include <gtest/gtest.h>
#include <raster/execute.h>
#include <testing/matchers.h>
#include <testing/window.h>
using namespace gnomon::raster;
using namespace gnomon::testing;

TEST(ShadowVolume, CountsWhereTheFloorLiesInsideIt) {
  DepthBuffer depth(10, 6);
  StencilBuffer stencil(10, 6);
  Frame frame;
  frame.begin_pass("floor, deeper on the right", {.depth = &depth});
  frame.draw(window_quad(frame, {.depth = DepthState{}}, {0, 0, 5, 6}, 0.5f));
  frame.draw(window_quad(frame, {.depth = DepthState{}}, {5, 0, 5, 6}, 0.9f));
  frame.begin_pass("two volumes, z-fail", {.depth = &depth, .stencil = &stencil});
  const StencilState count{.front = {.depth_fail = StencilOp::decr_wrap},
                           .back = {.depth_fail = StencilOp::incr_wrap}};
  const State volume{.depth = DepthState{CompareFunc::less, false}, .stencil = count};
  frame.draw(window_box(frame, volume, {1, 1, 6, 3}, 0.2f, 0.7f));
  frame.draw(window_box(frame, volume, {3, 2, 6, 3}, 0.4f, 0.95f));
  execute(frame);
  EXPECT_THAT(stencil, StencilIs(R"(
    ..........
    ...111111.
    .11221111.
    .11221111.
    .1111.....
    ..........)"));
}
