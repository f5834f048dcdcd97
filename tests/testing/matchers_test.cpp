// Oracle: buffers whose differences were put there by hand, and the sentences written here.
#include "testing/matchers.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

using namespace gnomon::raster;
using namespace gnomon::testing;
using ::testing::AllOf;
using ::testing::Not;
using ::testing::ThrowsMessage;

namespace {

/// Why the matcher refuses a value.
template <class Matcher, class Buffer>
std::string refusal(const Matcher& matcher, const Buffer& actual) {
  ::testing::StringMatchResultListener listener;
  EXPECT_FALSE(matcher.MatchAndExplain(actual, &listener));
  return listener.str();
}

ColorBuffer color_with(ColorFormat format, const glm::vec4& at_1_1) {
  ColorBuffer color(3, 2, format);
  if (format == ColorFormat::rgba8)
    for (int c = 0; c < 4; ++c)
      color.rgba8().at(1, 1)[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(at_1_1[c]);
  else
    color.rgba32f().at(1, 1) = at_1_1;
  return color;
}

}  // namespace

TEST(StencilEquals, RefusesADifferenceAtAnyPixelOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {63, 65}, {64, 64}, {130, 97}}) {
    const StencilBuffer expected(width, height);
    EXPECT_THAT(expected, StencilEquals(expected));
    for (const auto& [x, y] : {std::pair{0, 0}, {width - 1, height - 1}, {width / 2, height / 3}}) {
      StencilBuffer actual = expected;
      actual.plane().at(x, y) = 5;
      const std::string place = "(" + std::to_string(x) + ", " + std::to_string(y) + ")";
      EXPECT_EQ(
          refusal(StencilEquals(expected), actual),
          "which differs at 1 of " + std::to_string(width * height) + " pixels\nfirst at " + place +
              ": 5, expected 0\nlargest difference 5, at " + place + "\nx " + std::to_string(x) +
              "; . equal, + more, - less\n" + std::string(4 + std::to_string(y).size(), ' ') +
              "expected  actual  difference\ny " + std::to_string(y) + "  .         5       +\n");
    }
  }
}

TEST(StencilEquals, ComparesPixelsAndNeverThePaddingOfTheStorage) {
  StencilBuffer expected(1, 1), actual(1, 1);
  DepthBuffer expected_depth(1, 1), actual_depth(1, 1);
  ColorBuffer expected_color(1, 1), actual_color(1, 1);
  for (int i = 1; i < kPixelsPerTile; ++i) {
    actual.plane().tile(0, 0)[i] = 9;
    actual_depth.plane().tile(0, 0)[i] = 9;
    actual_color.rgba8().tile(0, 0)[i] = {9, 9, 9, 9};
  }
  EXPECT_THAT(actual, StencilEquals(expected));
  EXPECT_THAT(actual_depth, DepthEquals(expected_depth));
  EXPECT_THAT(actual_color, ColorEquals(expected_color));
}

TEST(StencilEquals, RefusesAnotherSize) {
  EXPECT_EQ(refusal(StencilEquals(StencilBuffer(3, 2)), StencilBuffer(2, 3)),
            "which is a 2x3 stencil buffer, not a 3x2 stencil buffer");
}

TEST(StencilEquals, ComposesWithOtherMatchers) {
  const StencilBuffer stencil = stencil_of("12");
  EXPECT_THAT(stencil, Not(StencilIs("21")));
  EXPECT_THAT(stencil, AllOf(StencilIs("12"), Not(StencilEquals(StencilBuffer(2, 1)))));
  EXPECT_THAT(&stencil, ::testing::Pointee(StencilIs("12")));
}

TEST(StencilIs, ShowsExpectedActualAndDifferenceBesideEachOther) {
  const StencilBuffer actual = stencil_of(R"(
    ......
    .1321.
    .1221.
    .1A...)");
  EXPECT_EQ(refusal(StencilIs(R"(
    ......
    .1221.
    .1221.
    .11..1)"),
                    actual),
            "which differs at 3 of 24 pixels\n"
            "first at (2, 0): 255, expected 1\n"
            "largest difference 254, at (2, 0)\n"
            "x 2 to 5; . equal, + more, - less\n"
            "     expected  actual  difference\n"
            "y 2  221.      321.    +...\n"
            "y 1  221.      221.    ....\n"
            "y 0  1..1      A...    +..-\n");
}

TEST(StencilIs, FailsAsGoogleTestPrintsIt) {
  const StencilBuffer stencil = stencil_of(".1\n..");
  EXPECT_NONFATAL_FAILURE(EXPECT_THAT(stencil, StencilIs(".1 \n .2")),
                          "Value of: stencil\n"
                          "Expected: equals a 2x2 stencil buffer, values 0 to 2\n"
                          ".1\n"
                          ".2\n"
                          "  Actual: 2x2 stencil buffer, values 0 to 1\n"
                          ".1\n"
                          "..\n"
                          " (of type gnomon::raster::StencilBuffer), which differs at 1 of 4 "
                          "pixels\n"
                          "first at (1, 0): 0, expected 2\n"
                          "largest difference 2, at (1, 0)\n"
                          "x 1; . equal, + more, - less\n"
                          "     expected  actual  difference\n"
                          "y 0  2         .       -\n");
}

TEST(Picture, OfAWideDifferenceShowsTheDifferenceAlone) {
  // Three columns of 22 would be more than 64 characters.
  const StencilBuffer expected(22, 1);
  StencilBuffer actual = expected;
  actual.plane().at(0, 0) = actual.plane().at(21, 0) = 1;
  EXPECT_EQ(refusal(StencilEquals(expected), actual),
            "which differs at 2 of 22 pixels\n"
            "first at (0, 0): 1, expected 0\n"
            "largest difference 1, at (0, 0)\n"
            "x 0 to 21; . equal, + more, - less\n"
            "y 0  +....................+\n");
}

TEST(Picture, OfALargeDifferenceHasACharacterForABlockOfPixels) {
  // 65 pixels from x = 10 to 74 do not fit 64 characters: blocks of 2x2 from (10, 8), the last ones
  // cut off.
  StencilBuffer expected(130, 97), actual(130, 97);
  for (int x = 10; x < 75; ++x) actual.plane().at(x, 8) = 1;
  expected.plane().at(11, 9) = 7;
  expected.plane().at(74, 10) = 3;
  EXPECT_EQ(refusal(StencilEquals(expected), actual),
            "which differs at 67 of 12610 pixels\n"
            "first at (10, 8): 1, expected 0\n"
            "largest difference 7, at (11, 9)\n"
            "x 10 to 74, a character for 2x2 pixels; . equal, + more, - less, * mixed\n"
            "y 10   " +
                std::string(32, '.') + "-\ny 8-9  *" + std::string(32, '+') + "\n");
}

TEST(Picture, NeverHasMoreThan64Times32Characters) {
  for (const auto& [width, height] :
       {std::pair{64, 32}, {65, 32}, {64, 33}, {1000, 20}, {3, 700}}) {
    const StencilBuffer expected(width, height);
    StencilBuffer actual = expected;
    actual.plane().at(0, 0) = actual.plane().at(width - 1, height - 1) = 1;
    const std::string text = refusal(StencilEquals(expected), actual);
    std::size_t lines = 0, longest = 0;
    for (std::size_t at = text.find("\ny "); at != std::string::npos;
         at = text.find("\ny ", at + 1)) {
      const std::string line = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
      const std::size_t pixels = line.substr(line.rfind(' ') + 1).size();
      longest = std::max(longest, pixels);
      ++lines;
    }
    EXPECT_LE(lines, 32u);
    EXPECT_LE(longest, 64u);
    // The smallest block that fits is used.
    EXPECT_TRUE(lines > 16 || longest > 32) << text;
  }
}

TEST(DepthEquals, AllowsSoManyUnitsAndNoMore) {
  DepthBuffer expected(3, 2), actual(3, 2);
  actual.plane().at(0, 1) -= 2;
  expected.plane().at(1, 1) -= 3;
  EXPECT_THAT(actual, DepthEquals(expected, 3));
  EXPECT_THAT(expected, DepthEquals(expected));
  EXPECT_EQ(refusal(DepthEquals(expected, 2), actual),
            "which differs by more than 2 units at 1 of 6 pixels\n"
            "first at (1, 1): 16777215, expected 16777212\n"
            "largest difference 3, at (1, 1)\n"
            "x 1; . equal, + more, - less\n"
            "y 1  +\n");
  EXPECT_EQ(refusal(DepthEquals(expected), actual),
            "which differs at 2 of 6 pixels\n"
            "first at (0, 1): 16777213, expected 16777215\n"
            "largest difference 3, at (1, 1)\n"
            "x 0 to 1; . equal, + more, - less\n"
            "y 1  -+\n");
}

TEST(DepthEquals, RefusesAnotherFormat) {
  EXPECT_EQ(refusal(DepthEquals(DepthBuffer(3, 2)), DepthBuffer(3, 2, DepthFormat::d16)),
            "which is a 3x2 D16 depth buffer, not a 3x2 D24 depth buffer");
}

TEST(ColorEquals, NamesTheChannelsOfTheFirstPixel) {
  const ColorBuffer black = color_with(ColorFormat::rgba8, {0, 0, 0, 0});
  const ColorBuffer grey = color_with(ColorFormat::rgba8, {9, 9, 9, 255});
  const ColorBuffer blue = color_with(ColorFormat::rgba8, {0, 9, 20, 255});
  EXPECT_THAT(blue, ColorEquals(blue));
  EXPECT_EQ(refusal(ColorEquals(black), grey),
            "which differs at 1 of 6 pixels\n"
            "first at (1, 1): (9, 9, 9, 255), expected (0, 0, 0, 0)\n"
            "largest difference 255, at (1, 1)\n"
            "x 1; . equal, + more, - less\n"
            "y 1  +\n");
  EXPECT_EQ(refusal(ColorEquals(grey), blue),
            "which differs at 1 of 6 pixels\n"
            "first at (1, 1): (0, 9, 20, 255), expected (9, 9, 9, 255)\n"
            "largest difference 11, at (1, 1)\n"
            "x 1; . equal, + more, - less, * mixed\n"
            "y 1  *\n");
}

TEST(ColorEquals, RefusesAnotherFormat) {
  EXPECT_EQ(refusal(ColorEquals(ColorBuffer(3, 2)), ColorBuffer(3, 2, ColorFormat::rgba32f)),
            "which is a 3x2 RGBA32F colour buffer, not a 3x2 RGBA8 colour buffer");
}

TEST(ColorEquals, ComparesTheBitsOfFloats) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto with = [](float green) {
    return color_with(ColorFormat::rgba32f, {0.1f, green, 0, 1});
  };
  EXPECT_THAT(with(nan), ColorEquals(with(nan)));
  EXPECT_EQ(refusal(ColorEquals(with(0.5f)), with(0.25f)),
            "which differs at 1 of 6 pixels\n"
            "first at (1, 1): (0.100000001, 0.25, 0, 1), expected (0.100000001, 0.5, 0, 1)\n"
            "largest difference 0.25, at (1, 1)\n"
            "x 1; . equal, + more, - less\n"
            "y 1  -\n");
  EXPECT_EQ(refusal(ColorEquals(with(0.0f)), with(-0.0f)),
            "which differs at 1 of 6 pixels\n"
            "first at (1, 1): (0.100000001, -0, 0, 1), expected (0.100000001, 0, 0, 1)\n"
            "largest difference 0, at (1, 1)\n"
            "x 1; . equal, + more, - less, * mixed\n"
            "y 1  *\n");
  EXPECT_EQ(refusal(ColorEquals(with(1.0f)), with(nan)),
            "which differs at 1 of 6 pixels\n"
            "first at (1, 1): (0.100000001, nan, 0, 1), expected (0.100000001, 1, 0, 1)\n"
            "largest difference inf, at (1, 1)\n"
            "x 1; . equal, + more, - less, * mixed\n"
            "y 1  *\n");
}

TEST(EqualUnderMask, ComparesOnlyWhereTheMaskIsNotZero) {
  const StencilBuffer mask = stencil_of(R"(
    ....
    .1A.
    ....)");
  const StencilBuffer expected(4, 3);
  StencilBuffer outside = stencil_of("5555\n5..5\n5555");
  EXPECT_THAT(outside, EqualUnderMask(expected, mask));
  EXPECT_THAT(outside, Not(StencilEquals(expected)));
  outside.plane().at(2, 1) = 4;
  EXPECT_EQ(refusal(EqualUnderMask(expected, mask), outside),
            "which differs at 1 of 2 pixels under the mask\n"
            "first at (2, 1): 4, expected 0\n"
            "largest difference 4, at (2, 1)\n"
            "x 2; . equal, + more, - less\n"
            "     expected  actual  difference\n"
            "y 1  .         4       +\n");
}

TEST(EqualUnderMask, LeavesBlankWhatIsNotCompared) {
  const StencilBuffer mask = stencil_of("1.1\n.1.");
  DepthBuffer expected(3, 2), actual(3, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) actual.plane().at(x, y) = 5;
  expected.plane().at(1, 0) = 6;
  EXPECT_EQ(refusal(EqualUnderMask(expected, mask, 1), actual),
            "which differs by more than 1 unit at 2 of 3 pixels under the mask\n"
            "first at (0, 1): 5, expected 16777215\n"
            "largest difference 16777210, at (0, 1)\n"
            "x 0 to 2; . equal, + more, - less, blank not compared\n"
            "y 1  - -\n");
}

TEST(EqualUnderMask, ComparesColourToo) {
  const ColorBuffer black(3, 2), dot = color_with(ColorFormat::rgba8, {0, 0, 0, 1});
  EXPECT_THAT(dot, EqualUnderMask(black, stencil_of("1.1 \n 111")));
  EXPECT_THAT(dot, Not(EqualUnderMask(black, stencil_of("111 \n 111"))));
}

TEST(EqualUnderMask, RefusesAMaskThatPicksNothingOrDoesNotFit) {
  const StencilBuffer expected(4, 3);
  EXPECT_THAT([&] { EqualUnderMask(expected, StencilBuffer(4, 3)); },
              ThrowsMessage<std::invalid_argument>("a mask picks at least one pixel"));
  EXPECT_THAT(
      [&] { EqualUnderMask(expected, stencil_of("111")); },
      ThrowsMessage<std::invalid_argument>("a mask has the size of the buffer it is laid over"));
}

TEST(Matchers, DescribeWhatTheyExpect) {
  std::ostringstream text;
  StencilIs("12").DescribeTo(&text);
  text << '|';
  StencilIs("12").DescribeNegationTo(&text);
  text << '|';
  EqualUnderMask(DepthBuffer(3, 2), stencil_of("111 \n 111"), 1).DescribeTo(&text);
  text << '|';
  DepthEquals(DepthBuffer(3, 2, DepthFormat::d16), 20).DescribeNegationTo(&text);
  text << '|';
  ColorEquals(ColorBuffer(3, 2)).DescribeTo(&text);
  EXPECT_EQ(text.str(),
            "equals a 2x1 stencil buffer, values 1 to 2\n12|"
            "does not equal a 2x1 stencil buffer, values 1 to 2\n12|"
            "equals, to within 1 unit, under a mask, a 3x2 D24 depth buffer, values 16777215 to "
            "16777215|"
            "does not equal, to within 20 units, a 3x2 D16 depth buffer, values 65535 to 65535|"
            "equals a 3x2 RGBA8 colour buffer");
}
