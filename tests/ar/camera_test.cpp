// Oracles: OpenCV's projectPoints for the lens equations, the files' own text for the readers, and
// that the inverse undoes the function.
#include "ar/camera.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>

#include "ar/error.h"
#include "temp_file.h"

namespace gnomon::ar {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::filesystem::path data(const std::string& name) {
  return std::filesystem::path(GNOMON_SOURCE_DIR) / "tests/data/cameras" / name;
}

std::string error_of(std::string_view text) {
  const TempFile file(text, ".yml");
  try {
    read_camera(file.path());
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr(file.path().string()), Not(HasSubstr("\n"))));
    return e.what();
  }
  return "no error";
}

const std::vector<std::vector<double>> kBrownLenses = {
    {},
    {-0.092, 0.038, 0.0, 0.0},
    {-0.26637260909660682, -0.038588898922304653, 1.7831947042852964e-03, -2.8122100441115472e-04,
     0.23839153080878486},
    {0.3, -0.1, 1e-3, -2e-3, 0.02, 0.5, -0.05, 0.01},
    {-0.2, 0.05, 1e-3, 5e-4, 0.0, 0.1, 0.0, 0.0, 1e-3, -5e-4, 2e-3, 1e-4},
    {-0.2, 0.05, 1e-3, 5e-4, 0.0, 0.1, 0.0, 0.0, 1e-3, -5e-4, 2e-3, 1e-4, 0.03, -0.02}};

TEST(Lens, ProjectsAsOpenCvDoesForEveryCountOfCoefficients) {
  for (const auto& k : kBrownLenses) {
    const CameraModel camera{640, 480, 618.4, 617.1, 322.7, 236.8, LensKind::brown_conrady, k};
    const Lens lens(camera);
    const cv::Matx33d matrix(618.4, 0, 322.7, 0, 617.1, 236.8, 0, 0, 1);
    for (double x = -0.5; x <= 0.5; x += 0.125) {
      for (double y = -0.4; y <= 0.4; y += 0.1) {
        std::vector<cv::Point2d> expected;
        cv::projectPoints(std::vector<cv::Point3d>{{2 * x, 2 * y, 2.0}}, cv::Vec3d{}, cv::Vec3d{},
                          matrix, k, expected);
        const auto pixel = lens.project({2 * x, 2 * y, 2.0});
        ASSERT_TRUE(pixel.has_value());
        EXPECT_NEAR(pixel->x, expected[0].x, 1e-9) << k.size() << " coefficients";
        EXPECT_NEAR(pixel->y, expected[0].y, 1e-9) << k.size() << " coefficients";
      }
    }
  }
}

TEST(Lens, FisheyeProjectsAsOpenCvDoes) {
  const std::vector<double> k{0.05, -0.02, 0.004, -0.001};
  const Lens lens({640, 480, 300.0, 301.0, 320.0, 240.0, LensKind::fisheye, k});
  const cv::Matx33d matrix(300.0, 0, 320.0, 0, 301.0, 240.0, 0, 0, 1);
  for (double x = -2.0; x <= 2.0; x += 0.25) {
    std::vector<cv::Point2d> expected;
    cv::fisheye::projectPoints(std::vector<cv::Point3d>{{x, 0.3 * x, 1.0}}, expected, cv::Vec3d{},
                               cv::Vec3d{}, matrix, k);
    const auto pixel = lens.project({x, 0.3 * x, 1.0});
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->x, expected[0].x, 1e-9);
    EXPECT_NEAR(pixel->y, expected[0].y, 1e-9);
  }
}

TEST(Lens, UndistortUndoesDistortOnEveryPixelOfThePicture) {
  auto lenses = kBrownLenses;
  for (const auto& k : lenses) {
    const Lens lens({640, 480, 618.4, 617.1, 322.7, 236.8, LensKind::brown_conrady, k});
    for (int y = 0; y < 480; y += 13) {
      for (int x = 0; x < 640; x += 13) {
        const auto n = lens.undistort({x, y});
        ASSERT_TRUE(n.has_value()) << x << " " << y << " " << k.size();
        const auto pixel = lens.project({n->x, n->y, 1.0});
        ASSERT_TRUE(pixel.has_value());
        EXPECT_LT(glm::distance(*pixel, glm::dvec2(x, y)), 1e-6);
      }
    }
  }
}

TEST(Lens, PointsBeyondTheTurningRadiusHaveNoPixelAndPixelsBeyondItsImageNoDirection) {
  // r (1 - r^2 / 3) turns at r = 1, where it is 2 / 3: both closed form.
  const Lens lens({1000, 1000, 500, 500, 500, 500, LensKind::brown_conrady, {-1.0 / 3.0, 0, 0, 0}});
  EXPECT_NEAR(lens.max_radius(), 1.0, 1e-6);
  EXPECT_TRUE(lens.project({0.99, 0, 1}).has_value());
  EXPECT_FALSE(lens.project({1.01, 0, 1}).has_value());
  EXPECT_TRUE(lens.undistort({500 + 500 * 0.66, 500}).has_value());
  EXPECT_FALSE(lens.undistort({500 + 500 * 0.67, 500}).has_value());
}

TEST(Lens, PointsBehindTheCameraAndValuesThatAreNotFiniteHaveNoPixel) {
  const Lens lens({640, 480, 600, 600, 320, 240, LensKind::brown_conrady, {}});
  EXPECT_FALSE(lens.project({0, 0, -1}).has_value());
  EXPECT_FALSE(lens.project({0, 0, 0}).has_value());
  EXPECT_FALSE(lens.project({NAN, 0, 1}).has_value());
  EXPECT_FALSE(lens.undistort({INFINITY, 0}).has_value());
  EXPECT_FALSE(lens.undistort({0, NAN}).has_value());
}

TEST(Lens, RandomCoefficientsNeverGiveAWrongInverse) {
  std::mt19937 random(7);
  std::normal_distribution<double> radial(0.0, 0.5), small(0.0, 0.01);
  std::uniform_real_distribution<double> x(-300, 940), y(-300, 780);
  int inverted = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> k{radial(random), radial(random), small(random),  small(random),
                                radial(random), radial(random), radial(random), radial(random)};
    const Lens lens({640, 480, 500, 500, 320, 240, LensKind::brown_conrady, k});
    const glm::dvec2 pixel{x(random), y(random)};
    const auto n = lens.undistort(pixel);
    if (!n) continue;
    ++inverted;
    const glm::dvec2 d = lens.distort(*n);
    EXPECT_LT(glm::distance(glm::dvec2(500 * d.x + 320, 500 * d.y + 240), pixel), 1e-6);
    EXPECT_LE(glm::length(*n), lens.max_radius());
  }
  EXPECT_GT(inverted, 1000);
}

TEST(CameraFile, OpenCvYamlGivesItsNumbers) {
  const CameraModel c = read_camera(data("opencv_left_intrinsics.yml"));
  EXPECT_EQ(c.width, 640);
  EXPECT_EQ(c.height, 480);
  EXPECT_EQ(c.fx, 5.3591573396163199e+02);
  EXPECT_EQ(c.cx, 3.4228315473308373e+02);
  EXPECT_EQ(c.cy, 2.3557082909788173e+02);
  EXPECT_THAT(c.distortion,
              ElementsAre(-2.6637260909660682e-01, -3.8588898922304653e-02, 1.7831947042852964e-03,
                          -2.8122100441115472e-04, 2.3839153080878486e-01));
}

TEST(CameraFile, OpenCvYamlWithoutASizeLeavesItOpen) {
  const CameraModel c = read_camera(data("tutorial_camera_params.yml"));
  EXPECT_EQ(c.width, 0);
  EXPECT_EQ(c.height, 0);
  EXPECT_EQ(c.fy, 628.156);
  EXPECT_THAT(c.distortion, ElementsAre(0.0995485, -0.206384, 0.00754589, 0.00336531, 0));
}

TEST(CameraFile, RosCameraInfoIsReadInYamlAndInJson) {
  const CameraModel yaml = read_camera(data("ros_camera_info_isaac.yaml"));
  EXPECT_EQ(yaml.width, 1280);
  EXPECT_EQ(yaml.fx, 942.53242);
  EXPECT_THAT(yaml.distortion, ElementsAre(0.065725, -0.096954, 0.002318, 0.004110, 0.0));
  const CameraModel json = read_camera(data("ros_camera_info_isaac.json"));
  EXPECT_EQ(json.height, 1080);
  EXPECT_EQ(json.fy, 431.741273);
  EXPECT_EQ(json.cy, 441.878037);
}

TEST(CameraFile, BoofCvPinholeYamlGivesItsNumbers) {
  const CameraModel c = read_camera(data("boofcv_intrinsic.yaml"));
  EXPECT_EQ(c.width, 800);
  EXPECT_EQ(c.fy, 629.4057227776121);
  EXPECT_THAT(c.distortion, ElementsAre(0.07946796807805329, -0.1703344505939042, 0.0, 0.0, 0.0));
}

TEST(CameraFile, RosEquidistantIsTheFisheyeLens) {
  const TempFile file(
      "image_width: 640\nimage_height: 480\ndistortion_model: equidistant\n"
      "camera_matrix: {rows: 3, cols: 3, data: [300, 0, 320, 0, 300, 240, 0, 0, 1]}\n"
      "distortion_coefficients: {rows: 1, cols: 4, data: [0.1, 0, 0, 0]}\n",
      ".yaml");
  EXPECT_EQ(read_camera(file.path()).lens, LensKind::fisheye);
}

TEST(CameraFile, BadInputIsRefusedInOneLineThatNamesPlaceAndValue) {
  const std::string size = "image_width: 640\nimage_height: 480\n";
  const auto k = [&](const std::string& v) { return size + "camera_matrix: [" + v + "]\n"; };
  const std::string good = k("600, 0, 320, 0, 600, 240, 0, 0, 1");
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_THAT(error_of(k("-600, 0, 320, 0, 600, 240, 0, 0, 1")), HasSubstr("found -600"));
  EXPECT_THAT(error_of(k(".nan, 0, 320, 0, 600, 240, 0, 0, 1")),
              HasSubstr("camera_matrix[0]: expected a finite number, found '.nan'"));
  EXPECT_THAT(error_of(k("600, 0, .inf, 0, 600, 240, 0, 0, 1")), HasSubstr("camera_matrix[2]"));
  EXPECT_THAT(error_of(k("600, 5, 320, 0, 600, 240, 0, 0, 1")), HasSubstr("skewed"));
  EXPECT_THAT(error_of(k("600, 0, 320, 0, 600, 240, 0, 0, 2")), HasSubstr("rows [fx 0 cx]"));
  EXPECT_THAT(error_of(k("600, 0, 320")), HasSubstr("expected 9 values, found 3"));
  EXPECT_THAT(error_of(k("six, 0, 320, 0, 600, 240, 0, 0, 1")), HasSubstr("found 'six'"));
  EXPECT_THAT(error_of(good + "D: [1, 2, 3]\n"), HasSubstr("0, 4, 5, 8, 12 or 14"));
  EXPECT_THAT(error_of(good + "D: [1, 2, 3, .nan]\n"), HasSubstr("D[3]"));
  EXPECT_THAT(error_of(good + "distortion_model: fov\n"), HasSubstr("unknown model 'fov'"));
  EXPECT_THAT(error_of(good + "D: {rows: 1, cols: 9, data: [1, 2, 3, 4]}\n"),
              HasSubstr("1 x 9 values announced, 4 found"));
  EXPECT_THAT(error_of("image_width: -3\nimage_height: 4\n"), HasSubstr("found '-3'"));
  EXPECT_THAT(error_of("image_width: 640\n"), HasSubstr("image_height"));
  EXPECT_THAT(error_of("image_width: 640\nimage_height: 0\nK: [1]\n"), HasSubstr("no picture"));
  EXPECT_THAT(error_of(size), HasSubstr("camera_matrix: not found"));
  EXPECT_THAT(error_of(""), HasSubstr("expected keys and values"));
  EXPECT_THAT(error_of("[1, 2"), HasSubstr("not YAML"));
  EXPECT_THAT(error_of(std::string(5 << 20, ' ')), HasSubstr("larger"));
  EXPECT_THAT(error_of(std::string(100000, '[')), HasSubstr("not YAML"));
  EXPECT_THROW(read_camera("/nonexistent/camera.yml"), InputError);
  EXPECT_THROW(read_camera("/"), InputError);
}

TEST(CameraFile, NoTruncationOfAGoodFileCrashes) {
  std::ifstream in(data("opencv_left_intrinsics.yml"), std::ios::binary);
  const std::string all(std::istreambuf_iterator<char>(in), {});
  for (std::size_t n = 0; n < 800; n += 7) {
    const TempFile file(std::string_view(all).substr(0, n), ".yml");
    try {
      const Lens lens(read_camera(file.path()));
      EXPECT_GT(lens.max_radius(), 0.0);
    } catch (const InputError&) {
    }
  }
}

TEST(CameraForPicture, AHalfSizePictureKeepsEveryDirection) {
  const CameraModel c{
      640, 480, 618.4, 617.1, 322.7, 236.8, LensKind::brown_conrady, {-0.1, 0, 0, 0}};
  const CameraModel half = camera_for_picture(c, 320, 240);
  // The centre of a half-size pixel (0, 0) lies between the first two full-size ones.
  const auto a = Lens(c).undistort({0.5, 0.5}), b = Lens(half).undistort({0, 0});
  EXPECT_NEAR(a->x, b->x, 1e-12);
  EXPECT_NEAR(a->y, b->y, 1e-12);
  EXPECT_THROW(camera_for_picture(c, 640, 640), InputError);
}

}  // namespace
}  // namespace gnomon::ar
