// Oracle of this file: the slow exact renderer of tests/reference, byte for byte.
#include "reference/reference.h"

#include <gtest/gtest.h>

#include "random_frames.h"
#include "raster/execute.h"

using namespace gnomon;
using random_frames::random_frame;

namespace {

struct Size {
  int width, height;
};

/// Bytes that differ between the fast renderer on so many threads and the reference, for one seed.
std::size_t differing_bytes(std::uint32_t seed, Size size, int threads, raster::ColorFormat color,
                            raster::DepthFormat depth) {
  random_frames::Targets fast(size.width, size.height, color, depth);
  random_frames::Targets slow(size.width, size.height, color, depth);
  raster::execute(random_frame(seed, 40, fast), {.threads = threads});
  reference::execute(random_frame(seed, 40, slow));
  const std::vector<std::uint8_t> a = fast.bytes(), b = slow.bytes();
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

}  // namespace

class ReferenceAtSize : public ::testing::TestWithParam<Size> {};

TEST_P(ReferenceAtSize, RandomFramesEqualByteForByte) {
  const Size size = GetParam();
  const std::array<int, 5> threads{1, 2, 3, 7, 16};
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const auto color = seed % 3 ? raster::ColorFormat::rgba8 : raster::ColorFormat::rgba32f;
    const auto depth = seed % 2 ? raster::DepthFormat::d24 : raster::DepthFormat::d16;
    EXPECT_EQ(differing_bytes(seed, size, threads[seed % threads.size()], color, depth), 0u)
        << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ReferenceAtSize,
                         ::testing::Values(Size{1, 1}, Size{7, 5}, Size{63, 65}, Size{130, 70}),
                         [](const auto& p) {
                           return std::to_string(p.param.width) + "x" +
                                  std::to_string(p.param.height);
                         });

TEST(Reference, TheFirstCommandsAloneEqualByteForByte) {
  for (const std::size_t commands : {0u, 1u, 7u, 23u}) {
    random_frames::Targets fast(70, 40, raster::ColorFormat::rgba8, raster::DepthFormat::d24);
    random_frames::Targets slow(70, 40, raster::ColorFormat::rgba8, raster::DepthFormat::d24);
    raster::execute(random_frame(99, 40, fast), {.threads = 1, .commands = commands});
    reference::execute(random_frame(99, 40, slow), commands);
    EXPECT_EQ(fast.bytes(), slow.bytes()) << commands << " commands";
  }
}
