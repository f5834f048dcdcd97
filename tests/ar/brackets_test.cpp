// Oracle: the contract in brackets.h, one broken rule at a time.
#include "ar/brackets.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ar/error.h"
#include "ar/image_file.h"
#include "temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;

class BracketsOfFiles : public testing::Test {
 protected:
  void picture(const char* name, std::uint8_t value, int width = 4) {
    write_png(folder_.path() / name,
              {width, 2, 3, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * 6, value)});
  }
  Brackets read(const std::string& text) {
    const auto list = folder_.path() / "exposures.json";
    std::ofstream(list) << text;
    return read_brackets(list);
  }
  std::string error_of(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "no error";
  }
  std::string two(const std::string& first, const std::string& second) {
    return R"({"exposures": [{"file": "a.png", "time_s": )" + first +
           R"(}, {"file": "b.png", "time_s": )" + second + "}]}";
  }

  TemporaryFolder folder_;
};

TEST_F(BracketsOfFiles, AreSortedByTimeWithThePhotographsTime) {
  picture("a.png", 200);
  picture("b.png", 50);
  const Brackets set = read(R"({"note": "other keys are left alone", "auto_exposure_time_s": 0.25,
    "exposures": [{"file": "a.png", "time_s": 0.5}, {"file": "b.png", "time_s": 0.1}]})");
  ASSERT_EQ(set.exposures.size(), 2u);
  EXPECT_EQ(set.exposures[0].time_s, 0.1);
  EXPECT_EQ(set.exposures[0].picture.pixels[0], 50);
  EXPECT_EQ(set.photograph_time_s, 0.25);
  EXPECT_EQ(set.width(), 4);
}

TEST_F(BracketsOfFiles, NeedTwoExposuresOrMore) {
  picture("a.png", 50);
  EXPECT_THAT(error_of(R"({"exposures": [{"file": "a.png", "time_s": 1}]})"),
              HasSubstr("exposures.json:1: exposures: 1 exposures are not 2 to 64"));
  EXPECT_THAT(error_of(R"({"exposures": []})"), HasSubstr("0 exposures are not 2 to 64"));
  EXPECT_THAT(error_of(R"({"exposures": 3})"), HasSubstr("expected a list"));
  EXPECT_THAT(error_of(R"({})"), HasSubstr("expected a list"));
  EXPECT_THAT(error_of("["), HasSubstr("not YAML"));
}

TEST_F(BracketsOfFiles, RefuseTimesThatAreNone) {
  picture("a.png", 50);
  picture("b.png", 100);
  EXPECT_THAT(error_of(two("0", "1")), HasSubstr("exposures[0].time_s: 0 is no exposure time"));
  EXPECT_THAT(error_of(two("1", "-2")), HasSubstr("exposures[1].time_s: -2 is no exposure time"));
  EXPECT_THAT(error_of(two("1", ".nan")), HasSubstr("exposures[1].time_s"));
  EXPECT_THAT(error_of(two("1", "\"long\"")), HasSubstr("exposures[1].time_s"));
  EXPECT_THAT(error_of(two("1", "1e9")), HasSubstr("no exposure time"));
  EXPECT_THAT(error_of(two("0.5", "0.5")), HasSubstr("all 2 take 0.5 s"));
  EXPECT_THAT(error_of(R"({"exposures": [{"file": "a.png"}, {"file": "b.png", "time_s": 1}]})"),
              HasSubstr("exposures[0].time_s"));
  EXPECT_THAT(error_of(R"({"exposures": [7, {"file": "b.png", "time_s": 1}]})"),
              HasSubstr("exposures[0]: expected {file, time_s}"));
}

TEST_F(BracketsOfFiles, RefuseTimesThatDisagreeWithThePictures) {
  picture("a.png", 50);
  picture("b.png", 100);
  EXPECT_THAT(
      error_of(two("1", "0.5")),
      HasSubstr("a.png: 1 s, but darker (mean value 50.0) than a shorter exposure (100.0)"));
}

TEST_F(BracketsOfFiles, RefusePicturesThatSayNothing) {
  picture("a.png", 0);
  picture("b.png", 0);
  EXPECT_THAT(error_of(two("1", "2")), HasSubstr("every exposure is black"));
  picture("a.png", 255);
  picture("b.png", 255);
  EXPECT_THAT(error_of(two("1", "2")), HasSubstr("every exposure is saturated"));
}

TEST_F(BracketsOfFiles, RefusePicturesOfOtherSizesOrThatAreMissing) {
  picture("a.png", 50);
  EXPECT_THAT(error_of(two("1", "2")), HasSubstr("b.png: no such file"));
  picture("b.png", 100, 5);
  EXPECT_THAT(error_of(two("1", "2")), HasSubstr("b.png: 5 x 2 pixels, but "));
  EXPECT_THROW(read_brackets(folder_.path() / "none.json"), InputError);
}

}  // namespace
}  // namespace gnomon::ar
