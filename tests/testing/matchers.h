// GoogleMock matchers for whole buffers. A failure says how many pixels differ, where the first
// one and the largest difference are, and draws where they lie (docs/testing.md). Only pixels are
// compared, never the padding of a buffer's storage; buffers of another size or format differ.
//
// A matcher keeps copies of what it is given.
#pragma once

#include <cstdint>
#include <string_view>

#include <gmock/gmock.h>

#include "raster/buffers.h"
#include "testing/text.h"

namespace gnomon::testing {

using StencilMatcher = ::testing::Matcher<const raster::StencilBuffer&>;
using DepthMatcher = ::testing::Matcher<const raster::DepthBuffer&>;
using ColorMatcher = ::testing::Matcher<const raster::ColorBuffer&>;

/// Every value is the same.
StencilMatcher StencilEquals(const raster::StencilBuffer& expected);
/// The counts are those that the text shows (testing/text.h), the top row first. Throws as
/// stencil_of does.
StencilMatcher StencilIs(std::string_view text);
/// No depth is further than so many units (integers of the buffer's format) from the expected one.
DepthMatcher DepthEquals(const raster::DepthBuffer& expected, std::uint32_t units = 0);
/// Every bit is the same, of float channels too: a NaN equals the same NaN, 0 does not equal -0.
ColorMatcher ColorEquals(const raster::ColorBuffer& expected);

/// The same, but only where the mask is not 0. Misuse (std::invalid_argument): a mask of another
/// size than the expected buffer, or one that picks no pixel: what compares nothing proves nothing.
StencilMatcher EqualUnderMask(const raster::StencilBuffer& expected,
                              const raster::StencilBuffer& mask);
DepthMatcher EqualUnderMask(const raster::DepthBuffer& expected, const raster::StencilBuffer& mask,
                            std::uint32_t units = 0);
ColorMatcher EqualUnderMask(const raster::ColorBuffer& expected, const raster::StencilBuffer& mask);

}  // namespace gnomon::testing
