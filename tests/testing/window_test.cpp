// Oracle: the rectangles and depths themselves.
#include "testing/window.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "raster/execute.h"
#include "testing/matchers.h"

using namespace gnomon::raster;
using namespace gnomon::testing;

namespace {

/// Adds 1 at each front face and takes 1 at each back face.
State signed_counting() {
  StencilState count;
  count.front.pass = StencilOp::incr_wrap;
  count.back.pass = StencilOp::decr_wrap;
  return {.stencil = count};
}

}  // namespace

TEST(WindowQuad, CoversExactlyItsPixelsWithItsFrontAtItsDepth) {
  // Sizes that are no power of two; rectangles across tiles, of one pixel, and beyond the target.
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {63, 65}, {131, 97}})
    for (const Rect& pixels :
         {Rect{0, 0, 1, 1}, Rect{0, 0, width, height}, Rect{2, 1, 62, 64}, Rect{-9, -9, 10, 11}}) {
      StencilBuffer stencil(width, height), expected(width, height);
      DepthBuffer depth(width, height), expected_depth(width, height);
      Frame frame;
      frame.begin_pass("quad", {.depth = &depth, .stencil = &stencil});
      State state = signed_counting();
      state.depth = DepthState{};
      frame.draw(window_quad(frame, state, pixels, 0.25f));
      execute(frame);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          if (x >= pixels.x && x < pixels.x + pixels.width && y >= pixels.y &&
              y < pixels.y + pixels.height) {
            expected.plane().at(x, y) = 1;
            expected_depth.plane().at(x, y) = 0x400000;  // a quarter of 2^24 - 1, rounded
          }
      EXPECT_THAT(stencil, StencilEquals(expected));
      EXPECT_THAT(depth, DepthEquals(expected_depth));
    }
}

TEST(WindowBox, TurnsItsFrontAndItsBackToTheEye) {
  for (const Cull cull : {Cull::none, Cull::back, Cull::front}) {
    StencilBuffer stencil(4, 3);
    Frame frame;
    frame.begin_pass("box", {.stencil = &stencil});
    State state = signed_counting();
    state.cull = cull;
    frame.draw(window_box(frame, state, {1, 0, 2, 2}, 0.2f, 0.8f));
    execute(frame);
    EXPECT_THAT(stencil, StencilIs(cull == Cull::none   ? "....\n....\n...."
                                   : cull == Cull::back ? "....\n.11.\n.11."
                                                        : "....\n.AA.\n.AA."));
  }
}

TEST(WindowBox, HasItsFacesAtItsTwoDepths) {
  // 0.25 and 0.75 times 2^24 - 1 are 4194303.75 and 12582911.25.
  for (const auto& [cull, expected] :
       {std::pair{Cull::back, 0x400000u}, {Cull::front, 0xbfffffu}}) {
    DepthBuffer depth(2, 2);
    Frame frame;
    frame.begin_pass("box", {.depth = &depth});
    State state{.depth = DepthState{}, .cull = cull};
    frame.draw(window_box(frame, state, {0, 0, 2, 2}, 0.25f, 0.75f));
    execute(frame);
    EXPECT_EQ(depth.at(1, 1), expected);
  }
}

TEST(WindowShapes, MisuseNamesTheRule) {
  StencilBuffer stencil(4, 3);
  Frame frame;
  EXPECT_THROW(window_quad(frame, {}, {0, 0, 1, 1}, 0.5f), std::invalid_argument);
  frame.begin_pass("shapes", {.stencil = &stencil});
  EXPECT_NO_THROW(window_quad(frame, {}, {0, 0, 1, 1}, 0.5f));
  EXPECT_THROW(window_quad(frame, {}, {0, 0, 1, 1}, 1.5f), std::invalid_argument);
  EXPECT_THROW(window_box(frame, {}, {0, 0, 1, 1}, 0.0f, -1.0f), std::invalid_argument);
  State state;
  state.viewport = Rect{0, 0, 2, 2};
  EXPECT_THROW(window_quad(frame, state, {0, 0, 1, 1}, 0.5f), std::invalid_argument);
  state.viewport.reset();
  state.depth_range.far = 0.5f;
  EXPECT_THROW(window_quad(frame, state, {0, 0, 1, 1}, 0.5f), std::invalid_argument);
}
