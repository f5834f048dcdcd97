#include "every_value.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace gnomon::conformance {

using namespace gnomon::raster;

std::uint32_t middle_depth(DepthFormat format) {
  return format == DepthFormat::d24 ? 0x800000u : 0x8000u;
}

Buffers every_value(Size size, DepthFormat format) {
  Buffers buffers(size, format);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int i = y * size.width + x;
      buffers.stencil.plane().at(x, y) = static_cast<std::uint8_t>(i % 256);
      buffers.depth.plane().at(x, y) =
          middle_depth(format) + static_cast<std::uint32_t>(i / 256 % 3) - 1u;
    }
  return buffers;
}

reference::Outcomes counted_outcomes(const State& state, int ref, bool front_facing) {
  reference::Outcomes outcomes;
  const StencilState both = state.stencil.value_or(StencilState{});
  const StencilFace& face = front_facing ? both.front : both.back;
  const int clamped = std::clamp(ref, 0, 255);
  for (int value = 0; value < 256; ++value)
    for (int stored = -1; stored <= 1; ++stored) {
      if (!accepts(face.func, clamped & face.read_mask, value & face.read_mask))
        ++outcomes.stencil_fail;
      else if (state.depth && !accepts(state.depth->func, 0, stored))
        ++outcomes.depth_fail;
      else
        ++outcomes.pass;
    }
  return outcomes;
}

void expect_same(const reference::Outcomes& got, const reference::Outcomes& wanted,
                 const std::string& name) {
  EXPECT_EQ(got.stencil_fail, wanted.stencil_fail) << name;
  EXPECT_EQ(got.depth_fail, wanted.depth_fail) << name;
  EXPECT_EQ(got.pass, wanted.pass) << name;
}

}  // namespace gnomon::conformance
