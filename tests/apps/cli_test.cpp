// The program as a person runs it: exit status, what goes to which stream, one line for an error.
// Oracles: the documented contract, and pictures whose measures have a closed form.
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ar/image_file.h"
#include "program.h"

namespace gnomon {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kData = GNOMON_SOURCE_DIR "/tests/data/metrics/";

TEST_F(Program, SaysItsVersionAndHelp) {
  const Outcome version = run({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, StartsWith("gnomon "));
  const Outcome help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, HasSubstr("Examples:"));
  EXPECT_EQ(run({"compare", "--help"}).status, 0);
}

TEST_F(Program, AnswersMisuseWithStatusOneAndAHint) {
  const std::vector<std::vector<std::string>> misuses = {{},
                                                         {"nonsense"},
                                                         {"--nonsense"},
                                                         {"compare"},
                                                         {"compare", "a.png", "b.png", "--what"},
                                                         {"compare", "a", "b", "--ppd", "x"}};
  for (const auto& arguments : misuses) {
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, StartsWith("gnomon: "));
    EXPECT_THAT(result.err, HasSubstr("--help"));
  }
  EXPECT_THAT(run({"nonsense"}).err, HasSubstr("'nonsense'"));
}

TEST_F(Program, CompareOfAPictureWithItselfFindsNoDifference) {
  const Outcome result = run({"compare", kData + "ref.png", kData + "ref.png", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["differing"], 0);
  EXPECT_EQ(json["rmse"], 0.0);
  EXPECT_TRUE(json["psnr"].is_null());
  EXPECT_NEAR(json["ssim"].get<double>(), 1.0, 1e-12);
  EXPECT_EQ(json["flip"], 0.0);
  EXPECT_TRUE(json["iou"].is_null()) << "a photograph is no mask";
}

TEST_F(Program, CompareMeasuresConstantsByTheirClosedForms) {
  const std::string a = write_picture("a.png", 12, 9, 1, 255);
  const std::string b = write_picture("b.png", 12, 9, 1, 105);
  const Outcome result = run({"compare", a, b, "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["width"], 12);
  EXPECT_EQ(json["height"], 9);
  EXPECT_EQ(json["pixels"], 108);
  EXPECT_EQ(json["differing"], 108);
  EXPECT_EQ(json["rmse"], 150.0);
  EXPECT_NEAR(json["psnr"].get<double>(), 20.0 * std::log10(255.0 / 150.0), 1e-12);
  EXPECT_EQ(json["iou"], 0.0);
  EXPECT_THAT(run({"compare", a, b}).out, HasSubstr("108 differ"));
}

TEST_F(Program, CompareLooksUnderTheMaskAndWritesTheErrorMap) {
  const std::string a = write_picture("a.png", 6, 4, 3, 10);
  const std::string b = write_picture("b.png", 6, 4, 3, 20);
  ar::Image mask{6, 4, 1, std::vector<std::uint8_t>(24, 0)};
  mask.at(2, 1)[0] = 255;
  ar::write_png(file("mask.png"), mask);
  const Outcome result = run({"compare", a, b, "--mask", file("mask.png"), "--json", "--flip-map",
                              file("map with space.png")});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["pixels"], 1);
  const ar::Image map = ar::read_image(file("map with space.png"));
  EXPECT_EQ(map.width, 6);
  EXPECT_EQ(map.height, 4);
}

TEST_F(Program, CompareTakesPicturesOfLinearLight) {
  const Outcome result =
      run({"compare", kData + "hdr_ref.exr", kData + "hdr_shadow.exr", "--json"});
  ASSERT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_TRUE(json["linear_light"].get<bool>());
  // By the authors' own program (tests/data/metrics/expected.json).
  EXPECT_NEAR(json["flip"].get<double>(), 0.076933, 5e-6);
}

TEST_F(Program, CompareRefusesBadPicturesInOneLine) {
  const std::string good = write_picture("good.png", 8, 8, 3, 1);
  const std::string wide = write_picture("wide.png", 9, 8, 3, 1);
  const std::string black = write_picture("black.png", 8, 8, 1, 127);
  const std::string png = text_of(good);
  std::ofstream(file("truncated.png")) << png.substr(0, png.size() / 2);
  std::ofstream(file("text.png")) << "no picture\nat all\n";
  std::ofstream(file("empty.png"));

  expect_one_line_error(run({"compare", good, file("missing.png")}), "missing.png");
  expect_one_line_error(run({"compare", file("truncated.png"), good}), "truncated.png");
  expect_one_line_error(run({"compare", good, file("text.png")}), "text.png");
  expect_one_line_error(run({"compare", good, file("empty.png")}), "empty.png");
  expect_one_line_error(run({"compare", good, GNOMON_BUILD_DIR}), GNOMON_BUILD_DIR);
  expect_one_line_error(run({"compare", good, wide}), "9x8");
  expect_one_line_error(run({"compare", good, good, "--mask", wide}), "wide.png");
  expect_one_line_error(run({"compare", good, good, "--mask", black}), "black.png");
  expect_one_line_error(run({"compare", good, good, "--flip-map", file("no/such/folder/map.png")}),
                        "map.png");
}

TEST_F(Program, SaysWhenItsOutputCannotBeWritten) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string good = write_picture("good.png", 8, 8, 3, 1);
  const std::string command = quoted(GNOMON_PROGRAM) + " compare " + quoted(good) + " " +
                              quoted(good) + " >/dev/full 2>" + quoted(file("stderr"));
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(text_of(file("stderr")), HasSubstr("standard output"));
}

}  // namespace
}  // namespace gnomon
