// How far pictures are apart. Oracles: closed forms of edges, lines and blobs that are moved or
// left out.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "ar/displacement.h"
#include "ar/error.h"
#include "ar/picture_error.h"

namespace gnomon::ar {
namespace {

constexpr int kSize = 48;
constexpr std::uint8_t kDark = 100, kLight = 200;
/// On a line from dark to light, values within the tolerance of an end lie so far from it.
constexpr double kTolerated = 3.0 / (kLight - kDark);

Image picture(const std::function<int(int, int)>& value) {
  Image image{kSize, kSize, 3, {}};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      image.pixels.insert(image.pixels.end(), 3, static_cast<std::uint8_t>(value(x, y)));
  return image;
}

Image edge_at(int column) {
  return picture([=](int x, int) { return x < column ? kDark : kLight; });
}

/// Light, but for the pixels that are `dark`.
Image with_dark(const std::function<bool(int, int)>& dark) {
  return picture([&](int x, int y) { return dark(x, y) ? kDark : kLight; });
}

double px(const Image& a, const Image& b) {
  const double there = displacement(a, b).px;
  EXPECT_EQ(displacement(b, a).px, there) << "both directions count alike";
  return there;
}

TEST(Displacement, OfEqualPicturesIsNothing) {
  const Displacement got = displacement(edge_at(20), edge_at(20));
  EXPECT_EQ(got.px, 0.0);
  EXPECT_EQ(got.differing, 0u);
}

TEST(Displacement, OfAnEdgeIsHowFarItWasMoved) {
  for (const int by : {1, 2, 5, 16})
    EXPECT_NEAR(px(edge_at(20), edge_at(20 + by)), by - kTolerated, 1e-9);
}

TEST(Displacement, OfAnEdgeMovedBeyondTheRadiusHasNoBound) {
  EXPECT_TRUE(displacement(edge_at(10), edge_at(28)).is_beyond());
}

TEST(Displacement, PassesOverValuesWithinTheTolerance) {
  const Image grey = picture([](int, int) { return 190; });
  EXPECT_EQ(px(grey, picture([](int, int) { return 193; })), 0.0);
  EXPECT_EQ(px(grey, picture([](int, int) { return 194; })),
            std::numeric_limits<double>::infinity());
}

TEST(Displacement, FindsAMissingLineOfOnePixel) {
  const Image none = with_dark([](int, int) { return false; });
  const Image upright = with_dark([](int x, int y) { return x == 20 && y < 30; });
  const Image slanted = with_dark([](int x, int y) { return x == y; });
  for (const Image* line : {&upright, &slanted})
    EXPECT_EQ(px(none, *line), std::numeric_limits<double>::infinity());
}

TEST(Displacement, FindsAMissingBlob) {
  const Image none = with_dark([](int, int) { return false; });
  const Image blob = with_dark([](int x, int y) { return std::hypot(x - 20, y - 20) < 3.0; });
  EXPECT_EQ(px(none, blob), std::numeric_limits<double>::infinity());
  // An inner pixel that became light is as far from light as the blob is deep.
  const Image big = with_dark([](int x, int y) { return x >= 10 && x < 25 && y >= 10 && y < 25; });
  const Image hole = with_dark([](int x, int y) {
    return x >= 10 && x < 25 && y >= 10 && y < 25 && !(x >= 16 && x < 19 && y >= 16 && y < 19);
  });
  EXPECT_NEAR(px(big, hole), 7.0 - kTolerated, 1e-9);
}

TEST(Displacement, PassesOverSpecksOfFourPixelsAndNotOfFive) {
  const Image none = with_dark([](int, int) { return false; });
  const Image four = with_dark([](int x, int y) { return y == 20 && x >= 10 && x < 14; });
  const Image five = with_dark([](int x, int y) { return y == 20 && x >= 10 && x < 15; });
  EXPECT_EQ(displacement(none, four).px, 0.0);
  EXPECT_EQ(displacement(none, four).passed_over, 4u);
  EXPECT_TRUE(displacement(none, five).is_beyond());
}

TEST(Displacement, FindsASmoothedEdgeWithinItsPixel) {
  const Image smooth = picture([](int x, int) { return x < 20 ? 100 : x == 20 ? 140 : 200; });
  // The hard edge's 200 at pixel 20 is 60 of the smooth one's values away, of which 3 are
  // tolerated.
  EXPECT_NEAR(px(edge_at(20), smooth), 57.0 / 60.0, 1e-9);
}

TEST(Displacement, LooksAtEachChannel) {
  Image red = edge_at(20), blue = edge_at(20);
  for (std::size_t i = 0; i < red.pixels.size(); i += 3) red.pixels[i] = 0;
  for (std::size_t i = 0; i < blue.pixels.size(); i += 3) blue.pixels[i + 2] = 0;
  EXPECT_EQ(px(red, blue), std::numeric_limits<double>::infinity());
}

// A value that lies between two neighbours' is looked for from one of their ends, which may be
// farther away than the radius. Oracle: a mirrored or turned picture has the same error.
TEST(Displacement, IsTheSameForMirroredAndTurnedPictures) {
  const auto step = [](int at) { return [at](int x, int) { return x <= at ? 255 : 0; }; };
  // A pixel of 128 lies between the two sides of the step, which is up to 17 pixels away.
  for (int at = 14; at <= 46; ++at) {
    const Image reference = picture(step(at));
    const Image test = picture([&](int x, int y) { return x == 32 ? 128 : step(at)(x, y); });
    const auto mirrored = [](const Image& image) {
      return picture([&](int x, int y) { return image.at(image.width - 1 - x, y)[0]; });
    };
    const auto turned = [](const Image& image) {
      return picture([&](int x, int y) { return image.at(y, x)[0]; });
    };
    EXPECT_EQ(px(reference, test), px(mirrored(reference), mirrored(test))) << at;
    EXPECT_EQ(px(reference, test), px(turned(reference), turned(test))) << at;
  }
}

TEST(PictureError, OfFlipIsAMeanOverWhatIsTouched) {
  const Image grey = picture([](int, int) { return kLight; });
  const Image blob = with_dark([](int x, int y) { return x < 8 && y < 8; });
  EXPECT_EQ(picture_error(ErrorUnit::flip, blob, blob, grey), 0.0);
  EXPECT_EQ(picture_error(ErrorUnit::flip, grey, grey, grey), 0.0);
  const double missing = picture_error(ErrorUnit::flip, blob, grey, grey);
  // The eye's filter spreads a difference of 100 values; over the whole picture it would be a tenth
  // of this.
  EXPECT_GT(missing, 0.1);
  EXPECT_LE(missing, 1.0);
}

TEST(PictureError, BoundsAreReadStrictly) {
  EXPECT_EQ(parse_error_bound("1px").unit, ErrorUnit::pixels);
  EXPECT_EQ(parse_error_bound("0.5px").value, 0.5);
  EXPECT_EQ(parse_error_bound("16px").value, 16.0);
  EXPECT_EQ(parse_error_bound("0.02flip").unit, ErrorUnit::flip);
  for (const char* text : {"", "px", "1", "1 px", "0px", "-1px", "nanpx", "infpx", "17px",
                           "1e999px", "1.5flip", "0flip", "1pxx", "1PX", "0x1px", "1\npx"})
    EXPECT_THROW(parse_error_bound(text), InputError) << text;
}

}  // namespace
}  // namespace gnomon::ar
