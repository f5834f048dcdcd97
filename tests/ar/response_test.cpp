// Oracles: closed forms and the table's own text.
#include "ar/response.h"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ar/error.h"
#include "temp_file.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;

std::string table(const std::string& middle, int rows = 256) {
  std::string text = "{\"inverse_table_rgb\": [";
  for (int v = 0; v < rows; ++v) {
    text += v == 100 && !middle.empty() ? middle : fmt::format("[{}, {}, {}]", v, v, 2 * v);
    text += v + 1 < rows ? "," : "]}";
  }
  return text;
}

std::string error_of(const std::string& text) {
  const TempFile file(text, ".json");
  try {
    read_response(file.path());
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Response, GammaIsThePowerOfTheValue) {
  const Response r = Response::from_gamma(2.0);
  EXPECT_EQ(r.light_from_value[0][0], 0.0f);
  EXPECT_EQ(r.light_from_value[2][255], 1.0f);
  EXPECT_FLOAT_EQ(r.light_from_value[1][51], 0.04f);
}

TEST(Response, TableIsScaledToOneAtItsLargestEntry) {
  const TempFile file(table(""), ".json");
  const Response r = read_response(file.path());
  EXPECT_FLOAT_EQ(r.light_from_value[2][255], 1.0f);
  EXPECT_FLOAT_EQ(r.light_from_value[0][255], 0.5f);
  EXPECT_FLOAT_EQ(r.light_from_value[1][51], 0.1f);
}

TEST(Response, BadTablesAreRefusedByPlaceAndValue) {
  EXPECT_THAT(error_of(table("[1, 2, 3]")),
              HasSubstr("inverse_table_rgb[100][0]: light falls to 1"));
  EXPECT_THAT(error_of(table("[100, .nan, 200]")), HasSubstr("inverse_table_rgb[100][1]"));
  EXPECT_THAT(error_of(table("[100, 100]")), HasSubstr("expected a triple"));
  EXPECT_THAT(error_of(table("7")), HasSubstr("inverse_table_rgb[100]"));
  EXPECT_THAT(error_of(table("", 255)), HasSubstr("256 triples"));
  EXPECT_THAT(error_of("{}"), HasSubstr("256 triples"));
  EXPECT_THAT(error_of(table("").substr(0, 2000)), HasSubstr("not YAML"));
}

TEST(Response, LinearLightWeighsChannelsAsRec709) {
  const Image pixel{1, 1, 3, {255, 0, 0}};
  EXPECT_FLOAT_EQ(linear_light(pixel, Response::from_gamma(2.2)).values[0], 0.2126f);
  const Image white{1, 1, 4, {255, 255, 255, 0}};
  EXPECT_FLOAT_EQ(linear_light(white, Response::from_gamma(2.2)).values[0], 1.0f);
  const Image half{1, 1, 1, {51}};
  EXPECT_NEAR(linear_light(half, Response::from_gamma(2.0)).values[0], 0.04, 1e-6);
}

TEST(Response, GreyKeepsGreyValuesExactly) {
  Image picture{256, 1, 3, {}};
  for (int v = 0; v < 256; ++v) {
    for (int c = 0; c < 3; ++c) picture.pixels.push_back(static_cast<std::uint8_t>(v));
  }
  const Image g = grey(picture);
  for (int v = 0; v < 256; ++v) EXPECT_EQ(g.pixels[static_cast<std::size_t>(v)], v);
}

}  // namespace
}  // namespace gnomon::ar
