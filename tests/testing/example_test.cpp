#include <raster/execute.h>
#include <testing/matchers.h>
#include <testing/window.h>
using namespace gnomon::raster;
using namespace gnomon::testing;

TEST(ShadowVolume, CountsWhereTheFloorLiesInsideIt) {
  DepthBuffer depth(10, 4);
  StencilBuffer stencil(10, 4);
  Frame frame;
  frame.begin_pass("a floor in the left half", {.depth = &depth});
  frame.draw(window_quad(frame, {.depth = DepthState{}}, {0, 0, 5, 4}, 0.5f));
  frame.begin_pass("two volumes, z-fail", {.depth = &depth, .stencil = &stencil});
  const StencilState count{.front = {.depth_fail = StencilOp::decr_wrap},
                           .back = {.depth_fail = StencilOp::incr_wrap}};
  const State volume{.depth = DepthState{CompareFunc::less, false}, .stencil = count};
  frame.draw(window_box(frame, volume, {1, 0, 6, 3}, 0.2f, 0.7f));
  frame.draw(window_box(frame, volume, {3, 1, 6, 3}, 0.4f, 0.8f));
  execute(frame);
  EXPECT_THAT(stencil, StencilIs(R"(
    ...11.....
    .1122.....
    .1122.....
    .1111.....)"));
}
