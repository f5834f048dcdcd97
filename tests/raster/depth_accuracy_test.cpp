// Depth against exact rational arithmetic (oracle: exact_depth.h), on seeded triangles that are
// hard on it: tiny, slivers, 8192 pixels wide, w from 1e-3 to 1e6, cut by every plane. The bounds
// are those of raster/depth_plane.h, not measured ones: half a unit of the last rounding, and 2^-(f
// + 1) each for the tile's base, for 63 steps in x, for 63 in y and for the offset.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "depth_batches.h"

using namespace gnomon;
using namespace gnomon::raster;
using depth_batches::Batch;
using depth_batches::Kind;
using depth_batches::Measured;

namespace {

double bound(DepthFormat format) { return format == DepthFormat::d24 ? 0.75 : 0.5 + 0x1p-10; }

/// Seeds first <= seed < end.
struct Seeds {
  std::uint32_t first = 0, end = 0;
};

/// Checks every kind's batches of these seeds, each on the next instruction set; returns what was
/// measured. `change` makes the batch's view another one.
Measured check(
    const Seeds& seeds, bool offset,
    const std::function<void(exact_depth::View&)>& change = [](auto&) {}) {
  const auto isas = available_isas();
  Measured all;
  for (const Kind kind : depth_batches::kKinds)
    for (std::uint32_t seed = seeds.first; seed < seeds.end; ++seed) {
      Batch batch = depth_batches::make_batch(kind, offset, seed);
      change(batch.view);
      const Isa isa = isas[(seed + static_cast<std::uint32_t>(kind)) % isas.size()];
      const Measured m =
          depth_batches::measure(batch, depth_batches::draw(batch, {.threads = 1, .isa = isa}),
                                 depth_batches::Planes::snapped);
      const auto where = [&] {
        return std::string(depth_batches::name(kind)) + ", seed " + std::to_string(seed) + ", " +
               std::string(name(isa));
      };
      EXPECT_LE(m.snapped.largest, bound(batch.view.format)) << where();
      EXPECT_EQ(m.coverage_differs, 0u) << where();
      all.add(m);
    }
  return all;
}

}  // namespace

TEST(ExactDepth, BothPlanesAreTheClosedFormOfARamp) {
  // Depth rises from 0 at the left border to 1 at the right one; an offset of half the slope moves
  // it by half a pixel.
  const auto at = [](float x, float y, float w) { return glm::vec4(x, y, x, 1.0f) * w; };
  const std::array<glm::vec4, 3> ramp{at(-1, -1, 4), at(1, -1, 0.5f), at(1, 1, 1)};
  for (const bool offset : {false, true}) {
    exact_depth::View view{.width = 16, .height = 8};
    if (offset) view.offset = PolygonOffset{0.5f, -2.0f};
    const auto pieces = exact_depth::snapped_pieces(ramp, view);
    ASSERT_EQ(pieces.size(), 1u);
    for (const exact_depth::Plane& plane :
         {pieces[0].plane(), exact_depth::unrounded_plane(ramp, view).value()})
      for (int x = 0; x < 16; ++x) {
        // In 1/32 unit, 0xffffff / 16 units a pixel.
        const Int128 units_32 = Int128{0xffffff} * (2 * x + 1 + offset) - (offset ? 64 : 0);
        EXPECT_TRUE(plane.at(x, 3) * 32 == units_32 * plane.one) << x;
      }
    const exact_depth::Span row = pieces[0].covered(3);
    EXPECT_EQ(row.first, 7);
    EXPECT_EQ(row.end, 16);
  }
}

TEST(ExactDepth, AnErrorIsTheDistanceToTheClampedDepth) {
  // Depth is 2 x + 1/2 units, clamped to [1, 5].
  const exact_depth::Plane plane{
      .origin = 1, .step_x = 4, .step_y = 0, .one = 2, .low = 2, .high = 10};
  exact_depth::Errors errors;
  errors.add(1, plane.at(0, 0), plane);
  errors.add(4, plane.at(1, 0), plane);
  errors.add(2, plane.at(4, 0), plane);
  EXPECT_EQ(errors.pixels, 3u);
  EXPECT_EQ(errors.beyond_one, 2u);
  EXPECT_EQ(errors.clamped, 2u);
  EXPECT_EQ(errors.largest, 3.0);
  EXPECT_EQ(errors.mean(), 1.5);
}

TEST(DepthAccuracy, IsThreeQuartersOfAUnitOfD24OnEveryKindOfTriangle) {
  const Measured m = check({0, 2}, false);
  EXPECT_GT(m.visible, 15000u);
  // A depth that is right to the last bit is a quarter of a unit off in the mean.
  EXPECT_NEAR(m.snapped.mean(), 0.25, 0.02);
}

TEST(DepthAccuracy, IsHardlyMoreThanHalfAUnitOfD16) {
  const Measured m = check({2, 3}, false, [](auto& view) { view.format = DepthFormat::d16; });
  EXPECT_GT(m.visible, 8000u);
  EXPECT_NEAR(m.snapped.mean(), 0.25, 0.02);
}

TEST(DepthAccuracy, DoesNotSufferFromPolygonOffset) {
  std::uint32_t seed = 3;
  for (const DepthFormat format : {DepthFormat::d24, DepthFormat::d16}) {
    const Measured m = check({seed, seed + 1}, true, [&](auto& view) { view.format = format; });
    EXPECT_GT(m.visible, 8000u);
    ++seed;
  }
}

TEST(DepthAccuracy, DoesNotSufferFromALargeOffsetFactor) {
  // One that multiplied the rounded slopes would be |factor| / 512 units off.
  std::uint32_t seed = 5;
  for (const float factor : {-1000.0f, 250.25f, 65536.0f}) {
    const Measured m = check({seed, seed + 1}, true, [&](auto& view) {
      view.offset = PolygonOffset{factor, -3.25f};
    });
    EXPECT_GT(m.visible, 8000u);
    ++seed;
  }
}

TEST(DepthAccuracy, HoldsWithDepthClampAndInEveryDepthRange) {
  std::uint32_t seed = 8;
  for (const DepthRange range : {DepthRange{0.25f, 0.625f}, DepthRange{1.0f, 0.0f},
                                 DepthRange{0.5f, 0.5f}, DepthRange{0.7f, 0.1f}}) {
    const Measured m = check({seed, seed + 1}, seed % 2 == 1, [&](auto& view) {
      view.range = range;
      view.clamp = true;
    });
    EXPECT_GT(m.visible, 8000u);
    ++seed;
  }
}
