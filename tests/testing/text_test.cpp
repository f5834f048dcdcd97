// Oracle: the alphabet of testing/text.h, written out here.
#include "testing/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "raster/stencil_text.h"

using namespace gnomon::raster;
using namespace gnomon::testing;
using ::testing::PrintToString;
using ::testing::ThrowsMessage;

namespace {

/// A row of 256 pixels with the values 0 to 255.
StencilBuffer every_value() {
  StencilBuffer ramp(256, 1);
  for (int x = 0; x < 256; ++x) ramp.plane().at(x, 0) = static_cast<std::uint8_t>(x);
  return ramp;
}

}  // namespace

TEST(StencilText, HasSmallLettersAboveNineAndCapitalsBelowZero) {
  const std::string between(194, '#');
  EXPECT_EQ(to_text(every_value()),
            ".123456789abcdefghijklmnopqrstuvwxyz" + between + "ZYXWVUTSRQPONMLKJIHGFEDCBA\n");
}

TEST(StencilText, ReadsEveryValueThatHasACharacter) {
  for (int value = 0; value < 256; ++value) {
    const char c = gnomon::raster::stencil_glyph(static_cast<std::uint8_t>(value));
    EXPECT_EQ(c == '#', value >= 36 && value < 230);
    if (c == '#') continue;
    EXPECT_EQ(stencil_of(std::string(1, c)).at(0, 0), value);
  }
}

TEST(StencilText, ShowsTheTopRowFirst) {
  StencilBuffer stencil(3, 2);
  stencil.plane().at(0, 1) = 1;
  stencil.plane().at(2, 0) = 255;
  EXPECT_EQ(to_text(stencil), "1..\n..A\n");
}

TEST(StencilText, ReadsBackWhatItWroteWhateverTheIndentation) {
  const StencilBuffer read = stencil_of("\n\n  \t 1..\r\n     ..A \n\n   ");
  EXPECT_EQ(to_text(read), "1..\n..A\n");
  EXPECT_EQ(read.width(), 3);
  EXPECT_EQ(read.height(), 2);
}

TEST(StencilText, RefusesWhatIsNoPictureAndNamesThePlace) {
  const auto refusal = [](const char* why) { return ThrowsMessage<std::invalid_argument>(why); };
  EXPECT_THAT([] { stencil_of("\n ..1\n .#1"); },
              refusal("stencil text, row 2, column 2: '#' stands for no one value (. 1-9 a-z A-Z "
                      "do)"));
  EXPECT_THAT([] { stencil_of("0"); },
              refusal("stencil text, row 1, column 1: '0' stands for no one value (. 1-9 a-z A-Z "
                      "do)"));
  EXPECT_THAT([] { stencil_of("...\n...\n.."); },
              refusal("stencil text, row 3, column 2: the row ends here, the first one at column "
                      "3"));
  EXPECT_THAT([] { stencil_of(".\n.."); },
              refusal("stencil text, row 2, column 2: the row ends here, the first one at column "
                      "1"));
  EXPECT_THAT([] { stencil_of(" \n "); }, refusal("stencil text without a pixel"));
  EXPECT_THAT([] { stencil_of(std::string(16385, '.')); },
              refusal("a buffer is 1 to 16384 pixels wide and high"));
}

TEST(Print, ShowsASmallStencilBufferAndSumsUpALargeOne) {
  EXPECT_EQ(PrintToString(stencil_of(".2\n..")), "2x2 stencil buffer, values 0 to 2\n.2\n..\n");
  EXPECT_EQ(PrintToString(every_value()), "256x1 stencil buffer, values 0 to 255");
  EXPECT_EQ(PrintToString(StencilBuffer(1, 33)), "1x33 stencil buffer, values 0 to 0");
}

TEST(Print, SumsUpDepthAndColour) {
  DepthBuffer depth(70, 3, DepthFormat::d16);
  depth.plane().at(69, 2) = 12;
  EXPECT_EQ(PrintToString(depth), "70x3 D16 depth buffer, values 12 to 65535");
  EXPECT_EQ(PrintToString(ColorBuffer(5, 4)), "5x4 RGBA8 colour buffer");
  EXPECT_EQ(PrintToString(ColorBuffer(5, 4, ColorFormat::rgba32f)), "5x4 RGBA32F colour buffer");
}
