// Oracles: closed forms, and what OpenCV's quality module says of the pairs in tests/data/metrics.
#include "ar/metrics.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "ar/image_file.h"

namespace gnomon::ar {
namespace {

const std::filesystem::path kData = std::filesystem::path(GNOMON_SOURCE_DIR) / "tests/data/metrics";

Image constant(int width, int height, int channels, std::uint8_t value) {
  Image image{width, height, channels, {}};
  image.pixels.assign(static_cast<std::size_t>(width) * height * channels, value);
  return image;
}

/// A pattern without symmetry, so that a mistake in an index shows.
Image pattern(int width, int height, int channels) {
  Image image = constant(width, height, channels, 0);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<std::uint8_t>((i * i * 31 + i * 7) % 251);
  }
  return image;
}

nlohmann::json expected() {
  std::ifstream file(kData / "expected.json");
  return nlohmann::json::parse(file);
}

/// The measure put together from OpenCV's own functions, in double precision.
double opencv_ssim(const Image& a, const Image& b) {
  const auto matrix = [](const Image& image) {
    cv::Mat result;
    cv::Mat(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.pixels.data()))
        .convertTo(result, CV_64F);
    return result;
  };
  const auto blur = [](const cv::Mat& m) {
    cv::Mat result;
    cv::GaussianBlur(m, result, cv::Size(11, 11), 1.5);
    return result;
  };
  const cv::Mat x = matrix(a), y = matrix(b), mean_x = blur(x), mean_y = blur(y);
  const cv::Mat var_x = blur(x.mul(x)) - mean_x.mul(mean_x);
  const cv::Mat var_y = blur(y.mul(y)) - mean_y.mul(mean_y);
  const cv::Mat cov = blur(x.mul(y)) - mean_x.mul(mean_y);
  const cv::Scalar c1 = cv::Scalar::all(6.5025), c2 = cv::Scalar::all(58.5225);
  const cv::Mat above = cv::Mat(2 * mean_x.mul(mean_y) + c1).mul(2 * cov + c2);
  const cv::Mat below =
      cv::Mat(mean_x.mul(mean_x) + mean_y.mul(mean_y) + c1).mul(var_x + var_y + c2);
  const cv::Scalar channels = cv::mean(above / below);
  return (channels[0] + channels[1] + channels[2]) / 3.0;
}

TEST(Difference, OfAPictureWithItselfIsNothing) {
  const Image image = pattern(37, 23, 3);
  const Difference d = difference(image, image);
  EXPECT_EQ(d.pixels, 37 * 23);
  EXPECT_EQ(d.differing, 0);
  EXPECT_EQ(d.largest, 0);
  EXPECT_EQ(d.rmse, 0.0);
  EXPECT_EQ(d.psnr, std::numeric_limits<double>::infinity());
}

TEST(Difference, CountsPixelsNotChannelsAndSumsSquaresExactly) {
  const Image a = constant(4, 3, 3, 100);
  Image b = a;
  b.at(1, 2)[0] = 103;
  b.at(1, 2)[1] = 96;
  b.at(3, 0)[2] = 112;
  const Difference d = difference(a, b);
  EXPECT_EQ(d.differing, 2);
  EXPECT_EQ(d.largest, 12);
  // (9 + 16 + 144) over 4 * 3 pixels of 3 channels.
  EXPECT_DOUBLE_EQ(d.rmse, 13.0 / 6.0);
  EXPECT_DOUBLE_EQ(d.psnr, 20.0 * std::log10(255.0 * 6.0 / 13.0));
}

TEST(Difference, LooksOnlyUnderTheMask) {
  const Image a = constant(5, 5, 3, 10);
  Image b = a, mask = constant(5, 5, 1, 127);
  b.at(0, 0)[0] = 255;
  b.at(4, 2)[1] = 20;
  mask.at(4, 2)[0] = 128;
  mask.at(3, 3)[0] = 255;
  const Difference d = difference(a, b, &mask);
  EXPECT_EQ(d.pixels, 2);
  EXPECT_EQ(d.differing, 1);
  EXPECT_EQ(d.largest, 10);
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(100.0 / 6.0));
}

TEST(Difference, AlphaIsCountedButIsNoColour) {
  Image a = constant(2, 1, 4, 255), b = a;
  b.at(1, 0)[3] = 0;
  const Difference d = difference(a, b);
  EXPECT_EQ(d.differing, 1);
  EXPECT_EQ(d.rmse, 0.0);
  EXPECT_EQ(difference(a, constant(2, 1, 3, 255)).differing, 0) << "without alpha is opaque";
}

TEST(Difference, GreyEqualsTheSameGreyInThreeChannels) {
  EXPECT_EQ(difference(constant(3, 3, 1, 77), constant(3, 3, 3, 77)).differing, 0);
}

TEST(Difference, RefusesOtherSizesAndAMaskThatPicksNothing) {
  const Image a = constant(4, 4, 3, 0), narrow = constant(3, 4, 3, 0);
  const Image nothing = constant(4, 4, 1, 0);
  EXPECT_THROW(difference(a, narrow), std::invalid_argument);
  EXPECT_THROW(difference(a, a, &nothing), std::invalid_argument);
  EXPECT_THROW(ssim(a, a, &nothing), std::invalid_argument);
  EXPECT_THROW(mask_iou(a, narrow), std::invalid_argument);
}

TEST(FloatDifference, SumsSquaresAndLooksUnderTheMask) {
  FloatImage a{2, 2, std::vector<float>(12, 1.0f)}, b = a;
  b.at(1, 0)[2] = 4.0f;
  b.at(0, 1)[0] = -3.0f;
  const FloatDifference d = difference(a, b);
  EXPECT_EQ(d.pixels, 4);
  EXPECT_EQ(d.differing, 2);
  EXPECT_EQ(d.largest, 4.0);
  EXPECT_DOUBLE_EQ(d.rmse, 5.0 / std::sqrt(12.0));
  Image mask = constant(2, 2, 1, 0);
  mask.at(1, 0)[0] = 255;
  EXPECT_DOUBLE_EQ(difference(a, b, &mask).rmse, std::sqrt(3.0));
}

TEST(MaskIou, OfTwoOverlappingSquaresIsTheirExactRatio) {
  Image a = constant(20, 20, 1, 0), b = constant(20, 20, 3, 0);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) {
      a.at(x, y)[0] = 128;
      for (int c = 0; c < 3; ++c) b.at(x + 5, y)[c] = 255;
    }
  }
  EXPECT_EQ(mask_iou(a, b), 50.0 / 150.0);
  EXPECT_EQ(mask_iou(a, a), 1.0);
}

TEST(MaskIou, OfEmptyMasksIsOneAndOfColoursIsNothing) {
  Image color = constant(4, 4, 3, 0);
  EXPECT_EQ(mask_iou(color, constant(4, 4, 1, 127)), 1.0);
  color.at(3, 3)[2] = 1;
  EXPECT_EQ(mask_iou(color, constant(4, 4, 1, 0)), std::nullopt);
}

TEST(Ssim, OfAPictureWithItselfIsOne) {
  EXPECT_NEAR(ssim(pattern(70, 90, 3), pattern(70, 90, 3)), 1.0, 1e-12);
}

TEST(Ssim, OfTwoConstantsIsTheLuminanceTerm) {
  const double c1 = 0.01 * 255 * 0.01 * 255;
  const double closed_form = (2.0 * 60 * 200 + c1) / (60.0 * 60 + 200.0 * 200 + c1);
  EXPECT_NEAR(ssim(constant(30, 17, 3, 60), constant(30, 17, 3, 200)), closed_form, 1e-9);
}

TEST(Ssim, WorksOnPicturesSmallerThanItsWindow) {
  EXPECT_NEAR(ssim(pattern(1, 1, 3), pattern(1, 1, 3)), 1.0, 1e-12);
  EXPECT_LT(ssim(pattern(2, 3, 3), constant(2, 3, 3, 9)), 0.9);
}

TEST(Ssim, DoesNotDependOnHowThePictureIsCutInBands) {
  // Rows 0-63 are one band, 64- the next: a picture and the same one 20 rows down differ in their
  // bands but not under a mask that stays clear of the borders.
  const Image a = pattern(40, 150, 1);
  Image b = a;
  for (std::size_t i = 0; i < b.pixels.size(); i += 5) b.pixels[i] ^= 32;
  const auto moved = [](const Image& image) {
    Image out = image;
    std::copy(image.pixels.begin(), image.pixels.end() - 20 * image.width,
              out.pixels.begin() + 20 * image.width);
    return out;
  };
  Image mask = constant(40, 150, 1, 0);
  for (int y = 50; y < 90; ++y) {
    for (int x = 0; x < 40; ++x) mask.at(x, y)[0] = 255;
  }
  const Image moved_mask = moved(mask);
  // The same values, added in another order.
  EXPECT_NEAR(ssim(a, b, &mask), ssim(moved(a), moved(b), &moved_mask), 1e-12);
}

TEST(Metrics, AgreeWithOpenCvOnRealPairs) {
  const nlohmann::json pairs = expected();
  const Image reference = read_image(kData / "ref.png");
  int compared = 0;
  for (const auto& [name, values] : pairs["ldr"].items()) {
    const Image test = read_image(kData / (name == "identical.png" ? "ref.png" : name));
    double mean = 0.0;
    for (double channel : values["ssim_bgr"]) mean += channel / 3.0;
    // The module takes variances in single precision. The same formula in single precision gives
    // its six digits exactly and in double (below) differs from them by up to 1.7e-5.
    EXPECT_NEAR(ssim(reference, test), mean, 2e-5) << name;
    EXPECT_NEAR(ssim(reference, test), opencv_ssim(reference, test), 1e-9) << name;
    if (values.contains("psnr_green")) {
      Image green_a = constant(reference.width, reference.height, 1, 0), green_b = green_a;
      for (std::size_t i = 0; i < green_a.pixels.size(); ++i) {
        green_a.pixels[i] = reference.pixels[3 * i + 1];
        green_b.pixels[i] = test.pixels[3 * i + 1];
      }
      EXPECT_NEAR(difference(green_a, green_b).psnr, values["psnr_green"].get<double>(), 1e-4)
          << name;
    }
    ++compared;
  }
  EXPECT_EQ(compared, 6);
}

}  // namespace
}  // namespace gnomon::ar
