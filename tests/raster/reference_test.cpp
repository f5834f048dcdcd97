// Oracle of this file: the slow exact renderer of tests/reference, byte for byte.
#include "reference/reference.h"

#include <gtest/gtest.h>

#include "random_frames.h"
#include "raster/execute.h"
#include "variants.h"

using namespace gnomon;
using random_frames::random_frame;

namespace {

struct Size {
  int width, height;
};

template <class Execute>
std::vector<std::uint8_t> bytes_after(std::uint32_t seed, Size size, Execute execute) {
  const auto color = seed % 3 ? raster::ColorFormat::rgba8 : raster::ColorFormat::rgba32f;
  const auto depth = seed % 2 ? raster::DepthFormat::d24 : raster::DepthFormat::d16;
  random_frames::Targets targets(size.width, size.height, color, depth);
  execute(random_frame(seed, 40, targets));
  return targets.bytes();
}

}  // namespace

class ReferenceAtSize : public ::testing::TestWithParam<Size> {};

TEST_P(ReferenceAtSize, RandomFramesEqualByteForByteOnEveryInstructionSet) {
  const Size size = GetParam();
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    const auto expected =
        bytes_after(seed, size, [](const raster::Frame& f) { reference::execute(f); });
    for (const auto& options : variants::every_isa(variants::kThreads[seed % 5]))
      EXPECT_EQ(
          bytes_after(seed, size, [&](const raster::Frame& f) { raster::execute(f, options); }),
          expected)
          << "seed " << seed << ", " << variants::name(options);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ReferenceAtSize,
                         ::testing::Values(Size{1, 1}, Size{7, 5}, Size{63, 65}, Size{130, 70}),
                         [](const auto& p) {
                           return std::to_string(p.param.width) + "x" +
                                  std::to_string(p.param.height);
                         });

TEST(Reference, PassesOfSeveralSizesEqualByteForByte) {
  // Size and attachments change from pass to pass and come back.
  for (std::uint32_t seed = 700; seed < 720; ++seed) {
    const auto run = [seed](auto execute) {
      random_frames::Targets large(130, 70, raster::ColorFormat::rgba8, raster::DepthFormat::d24);
      random_frames::Targets small(9, 66, raster::ColorFormat::rgba32f, raster::DepthFormat::d16);
      raster::ColorBuffer other(130, 70);
      raster::Frame frame;
      for (int pass = 0; pass < 3; ++pass) {
        random_frames::record_pass(frame, seed + 100 * pass, 8, large.all());
        random_frames::record_pass(frame, seed + 100 * pass + 20, 8, small.all());
        random_frames::record_pass(frame, seed + 100 * pass + 40, 8,
                                   {&other, &large.depth, &large.stencil});
      }
      execute(frame);
      std::vector<std::uint8_t> bytes = large.bytes();
      for (const std::uint8_t b : small.bytes()) bytes.push_back(b);
      for (const std::uint8_t b : other.to_rgba8_rows()) bytes.push_back(b);
      return bytes;
    };
    EXPECT_EQ(run([](const raster::Frame& f) { raster::execute(f, {.threads = 3}); }),
              run([](const raster::Frame& f) { reference::execute(f); }))
        << "seed " << seed;
  }
}

TEST(Reference, CoordinatesOfEverySizeEqualByteForByte) {
  // Differences of such coordinates round small ones away; pixels are still defined.
  random_frames::Random random(41);
  for (int round = 0; round < 200; ++round) {
    std::vector<glm::vec4> positions(60), colors(60);
    std::vector<std::uint32_t> indices;
    for (glm::vec4& p : positions) {
      float scale = 1.0f;
      for (int i = random.integer(-8, 30); i > 0; --i) scale *= 10.0f;
      for (int i = 0; i < 4; ++i) p[i] = scale * random.real(-1.0f, 1.0f);
      indices.push_back(static_cast<std::uint32_t>(indices.size()));
    }
    for (glm::vec4& c : colors) c = {random.real(0, 1), random.real(0, 1), 0, 1};
    random_frames::Targets fast(70, 66, raster::ColorFormat::rgba32f, raster::DepthFormat::d24);
    random_frames::Targets slow(70, 66, raster::ColorFormat::rgba32f, raster::DepthFormat::d24);
    for (random_frames::Targets* targets : {&fast, &slow}) {
      raster::Frame frame;
      frame.begin_pass("any size", targets->all());
      frame.draw({.state = {.depth = raster::DepthState{}, .depth_clamp = round % 2 == 0},
                  .mesh = {.positions = positions, .indices = indices, .colors = colors}});
      if (targets == &fast)
        raster::execute(frame);
      else
        reference::execute(frame);
    }
    ASSERT_EQ(fast.bytes(), slow.bytes()) << "round " << round;
  }
}

TEST(Reference, ABlitUnderAScissorEqualsByteForByte) {
  random_frames::Random random(43);
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 40 * 30 * 3; ++i)
    pixels.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
  for (int round = 0; round < 50; ++round) {
    raster::Blit blit{.image = raster::ImageView::from_top_row(pixels.data(), 40, 30, 3)};
    blit.x = random.integer(-45, 75);
    blit.y = random.integer(-35, 70);
    blit.scissor = raster::Rect{random.integer(-9, 70), random.integer(-9, 66),
                                random.integer(-1, 90), random.integer(-1, 90)};
    raster::ColorBuffer fast(70, 66), slow(70, 66);
    for (raster::ColorBuffer* color : {&fast, &slow}) {
      raster::Frame frame;
      frame.begin_pass("blit", {.color = color});
      frame.blit(blit);
      if (color == &fast)
        raster::execute(frame);
      else
        reference::execute(frame);
    }
    ASSERT_EQ(fast.to_rgba8_rows(), slow.to_rgba8_rows()) << "round " << round;
  }
}

TEST(Reference, MoreCommandsThanOneGroupHoldsEqualByteForByte) {
  random_frames::Targets fast(40, 30, raster::ColorFormat::rgba8, raster::DepthFormat::d24);
  random_frames::Targets slow(40, 30, raster::ColorFormat::rgba8, raster::DepthFormat::d24);
  raster::execute(random_frame(77, 1300, fast), {.threads = 2});
  reference::execute(random_frame(77, 1300, slow));
  EXPECT_EQ(fast.bytes(), slow.bytes());
}

TEST(Reference, TheFirstCommandsAloneEqualByteForByte) {
  for (const std::size_t commands : {0u, 1u, 7u, 23u}) {
    random_frames::Targets fast(70, 40, raster::ColorFormat::rgba8, raster::DepthFormat::d24);
    random_frames::Targets slow(70, 40, raster::ColorFormat::rgba8, raster::DepthFormat::d24);
    raster::execute(random_frame(99, 40, fast), {.threads = 1, .commands = commands});
    reference::execute(random_frame(99, 40, slow), commands);
    EXPECT_EQ(fast.bytes(), slow.bytes()) << commands << " commands";
  }
}
