// Oracles: tags drawn by the libraries themselves at known places, and photographs whose tags their
// own projects list.
#include "ar/tags.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <apriltag/apriltag.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "ar/error.h"
#include "ar/image_file.h"
#include "ar/tag_families.h"
#include "temp_file.h"

namespace gnomon::ar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::filesystem::path data(const std::string& name) {
  return std::filesystem::path(GNOMON_SOURCE_DIR) / "tests/data/tags" / name;
}

constexpr int kModule_px = 12;
constexpr int kMargin_px = 60;

/// A tag of one byte a module, enlarged, on white.
Image enlarged(const std::uint8_t* modules, int width, int stride) {
  const int size = width * kModule_px + 2 * kMargin_px;
  Image picture{size, size, 1,
                std::vector<std::uint8_t>(static_cast<std::size_t>(size) * size, 255)};
  for (int y = 0; y < width * kModule_px; ++y) {
    for (int x = 0; x < width * kModule_px; ++x) {
      *picture.at(kMargin_px + x, kMargin_px + y) =
          modules[(y / kModule_px) * stride + x / kModule_px];
    }
  }
  return picture;
}

/// A quarter turn clockwise.
Image turned(const Image& p) {
  Image out{p.height, p.width, 1, std::vector<std::uint8_t>(p.pixels.size())};
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) *out.at(p.height - 1 - y, x) = *p.at(x, y);
  }
  return out;
}

/// The corners as printed of a square whose sides lie between pixels.
TagCorners square(double low, double high) {
  const double a = low - 0.5, b = high - 0.5;
  return {glm::dvec2(a, a), {b, a}, {b, b}, {a, b}};
}

double farthest(const TagCorners& a, const TagCorners& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, glm::distance(a[i], b[i]));
  return worst;
}

TEST(Tags, EveryAprilTagFamilyIsFoundWithCornersAsPrinted) {
  for (const std::string& name : april_family_names()) {
    TagDetector detector({name});
    const AprilFamilyPtr family = make_april_family(name);
    for (const int number : {0, 3, 17}) {
      image_u8_t* drawn = apriltag_to_image(family.get(), number);
      const Image picture = enlarged(drawn->buf, drawn->width, drawn->stride);
      const int border = (drawn->width - family->width_at_border) / 2;
      // image_u8_destroy lives in a library of its own.
      std::free(drawn->buf);
      std::free(drawn);
      const double low = kMargin_px + kModule_px * border;
      const TagCorners expected = square(low, low + kModule_px * family->width_at_border);
      const auto found = detector.detect(picture);
      ASSERT_EQ(found.size(), 1u) << name << " " << number;
      EXPECT_EQ(found[0].id, (TagId{name, number}));
      EXPECT_EQ(found[0].hamming, 0);
      EXPECT_LT(farthest(found[0].corners_px, expected), 0.05) << name << " " << number;
      const auto after = detector.detect(turned(picture));
      ASSERT_EQ(after.size(), 1u) << name << " " << number;
      // The printed top left is now at the top right.
      const TagCorners moved{expected[1], expected[2], expected[3], expected[0]};
      EXPECT_LT(farthest(after[0].corners_px, moved), 0.05) << name << " " << number;
    }
  }
}

TEST(Tags, EveryArucoDictionaryIsFoundWithCornersAsPrinted) {
  for (const std::string& name : aruco_dictionary_names()) {
    TagDetector detector({name});
    const auto dictionary = predefined_dictionary(name);
    for (const int number : {1, 7, 23}) {
      const int width = dictionary->markerSize + 2;
      cv::Mat drawn;
      dictionary->drawMarker(number, width, drawn);
      const Image picture = enlarged(drawn.data, width, static_cast<int>(drawn.step));
      const TagCorners expected = square(kMargin_px, kMargin_px + width * kModule_px);
      const auto found = detector.detect(picture);
      ASSERT_EQ(found.size(), 1u) << name << " " << number;
      EXPECT_EQ(found[0].id, (TagId{name, number}));
      EXPECT_LT(farthest(found[0].corners_px, expected), 0.05) << name << " " << number;
      const auto after = detector.detect(turned(picture));
      ASSERT_EQ(after.size(), 1u) << name << " " << number;
      const TagCorners moved{expected[1], expected[2], expected[3], expected[0]};
      EXPECT_LT(farthest(after[0].corners_px, moved), 0.05) << name << " " << number;
    }
  }
}

/// Lines "id, (x y), (x y), (x y), (x y)" in AprilTag's pixels.
std::vector<std::pair<int, std::vector<glm::dvec2>>> listed(const std::filesystem::path& file) {
  std::vector<std::pair<int, std::vector<glm::dvec2>>> all;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == '(' || c == ')'; }, ' ');
    std::istringstream numbers(line);
    int id = 0;
    if (!(numbers >> id)) continue;
    std::vector<glm::dvec2> corners(4);
    for (glm::dvec2& p : corners) {
      numbers >> p.x >> p.y;
      p -= 0.5;
    }
    all.emplace_back(id, corners);
  }
  return all;
}

/// The listed corners come from a detector without linear light, hence up to 1 % of a tag's size
/// inside the true ones, and are rounded to whole pixels for ArUco: 1.5 pixels.
constexpr double kListed_px = 1.5;

double farthest_from_listed(const std::vector<glm::dvec2>& corners, const Detection& d) {
  double worst = 0.0;
  for (const glm::dvec2& p : corners) {
    double nearest = 1e9;
    for (const glm::dvec2& q : d.corners_px) nearest = std::min(nearest, glm::distance(p, q));
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(Tags, NasaPhotographsShowExactlyTheListedTags) {
  TagDetector detector({"tag36h11"});
  int pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data("apriltag_nasa"))) {
    if (entry.path().extension() != ".txt") continue;
    ++pictures;
    const auto expected = listed(entry.path());
    auto picture = entry.path();
    const auto found = detector.detect(read_image(picture.replace_extension(".jpg")));
    EXPECT_EQ(found.size(), expected.size()) << entry.path();
    for (const auto& [id, corners] : expected) {
      EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                              [&, n = id, &c = corners](const Detection& d) {
                                return d.id.number == n && farthest_from_listed(c, d) < kListed_px;
                              }))
          << entry.path() << " tag " << id;
    }
  }
  EXPECT_EQ(pictures, 3);
}

TEST(Tags, OpenCvPhotographShowsExactlyTheListedMarkers) {
  std::ifstream in(data("opencv_aruco/expected_corners.json"));
  const auto truth = nlohmann::json::parse(in).at("singlemarkersoriginal.jpg");
  TagDetector detector({"DICT_6X6_250"});
  const auto found = detector.detect(read_image(data("opencv_aruco/singlemarkersoriginal.jpg")));
  EXPECT_EQ(found.size(), 6u);
  for (const Detection& d : found) {
    const std::string key = std::to_string(d.id.number);
    ASSERT_TRUE(truth.contains(key)) << key;
    for (std::size_t c = 0; c < 4; ++c) {
      const glm::dvec2 p{truth[key][2 * c].get<double>(), truth[key][2 * c + 1].get<double>()};
      EXPECT_LT(glm::distance(d.corners_px[c], p), kListed_px) << key << " corner " << c;
    }
  }
}

TEST(Tags, CustomDictionariesAreReadAndFound) {
  TagDetector detector({"mip"}, {{"mip", data("boofcv_aruco25h7/aruco_mip_25h7_opencv_dict.yml")}});
  const auto found = detector.detect(read_image(data("boofcv_aruco25h7/image01.jpg")));
  std::vector<int> ids;
  for (const Detection& d : found) {
    EXPECT_EQ(d.id.family, "mip");
    ids.push_back(d.id.number);
  }
  EXPECT_THAT(ids, ElementsAre(0, 10));
}

TEST(Tags, NoFamilyWithWideCodesIsSeenWhereItIsNot) {
  const Image nasa = read_image(data("apriltag_nasa/34085369442_304b6bafd9_c.jpg"));
  const Image table = read_image(data("opencv_aruco/singlemarkersoriginal.jpg"));
  for (const std::string& name : april_family_names()) {
    TagDetector detector({name});
    if (name != "tag36h11") {
      EXPECT_TRUE(detector.detect(nasa).empty()) << name;
    }
    EXPECT_TRUE(detector.detect(table).empty()) << name;
  }
}

TEST(Tags, CorrectableBitsFollowFromTheCodesWhenTheFileDoesNotSay) {
  // Codes 111000000 and 000000111 are each other's half turn: distance 0. A lone 111100100 differs
  // from its own quarter turns in at least 4 of 9 bits, counted by hand: 1 bit can be corrected.
  const TempFile alike(
      "nmarkers: 2\nmarkersize: 3\nmarker_0: \"111000000\"\nmarker_1: \"000000111\"\n", ".yml");
  EXPECT_EQ(read_dictionary(alike.path())->maxCorrectionBits, 0);
  const TempFile lone("nmarkers: 1\nmarkersize: 3\nmarker_0: \"111100100\"\n", ".yml");
  EXPECT_EQ(read_dictionary(lone.path())->maxCorrectionBits, 1);
}

TEST(Tags, BadDictionariesAreRefusedByKeyAndValue) {
  const auto error_of = [](const std::string& text) -> std::string {
    const TempFile file(text, ".yml");
    try {
      TagDetector({"mine"}, {{"mine", file.path()}});
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  const std::string head = "%YAML:1.0\nnmarkers: 1\nmarkersize: 3\n";
  EXPECT_EQ(error_of(head + "marker_0: \"111100100\"\n"), "no error");
  EXPECT_THAT(error_of(head + "marker_0: \"11110010\"\n"), HasSubstr("expected 9 digits"));
  EXPECT_THAT(error_of(head + "marker_0: \"111100102\"\n"), HasSubstr("'111100102'"));
  EXPECT_THAT(error_of(head), HasSubstr("marker_0"));
  EXPECT_THAT(error_of("nmarkers: 1000000\nmarkersize: 3\n"), HasSubstr("from 1 to 4096"));
  EXPECT_THAT(error_of("nmarkers: 1\nmarkersize: 99\n"), HasSubstr("from 3 to 10"));
  EXPECT_THAT(error_of("nmarkers: 1\n"), HasSubstr("markersize"));
}

TEST(Tags, UnknownFamilyIsNamedBesideTheKnownOnes) {
  try {
    TagDetector({"tag99h9"});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("'tag99h9'"));
    EXPECT_THAT(e.what(), HasSubstr("tagStandard52h13"));
    EXPECT_THAT(e.what(), HasSubstr("DICT_ARUCO_ORIGINAL"));
  }
}

TEST(Tags, PicturesOfEverySmallSizeAndOfNoiseDoNotCrash) {
  std::mt19937 random(3);
  for (const double decimate : {1.0, 2.0}) {
    TagDetectorOptions options;
    options.decimate = decimate;
    TagDetector detector({"tag36h11", "tag16h5", "DICT_4X4_50"}, {}, options);
    for (int h = 0; h <= 40; h += 1 + h / 8) {
      for (int w = 0; w <= 40; w += 1 + w / 8) {
        Image picture{w, h, 1, std::vector<std::uint8_t>(static_cast<std::size_t>(w) * h)};
        for (auto& v : picture.pixels) v = static_cast<std::uint8_t>(random());
        EXPECT_TRUE(detector.detect(picture).empty());
      }
    }
    Image thin{400, 3, 1, std::vector<std::uint8_t>(1200, 128)};
    EXPECT_TRUE(detector.detect(thin).empty());
    Image flat{640, 480, 3, std::vector<std::uint8_t>(640 * 480 * 3, 255)};
    EXPECT_TRUE(detector.detect(flat).empty());
  }
}

}  // namespace
}  // namespace gnomon::ar
