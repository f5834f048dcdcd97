// Oracles: what the authors' own program says of the pairs in tests/data/metrics, and invariants.
#include "ar/flip.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ar/image_file.h"

namespace gnomon::ar {
namespace {

const std::filesystem::path kData = std::filesystem::path(GNOMON_SOURCE_DIR) / "tests/data/metrics";

/// The authors compute in single precision, in another order, and their mean sums 10^5 floats; the
/// figures are printed with six digits.
constexpr double kMeanTolerance = 5e-6;
/// A single pixel's error may move a little more: its exponents amplify small differences.
constexpr double kPixelTolerance = 5e-5;

nlohmann::json expected() {
  std::ifstream file(kData / "expected.json");
  return nlohmann::json::parse(file);
}

/// The error at which half of all error lies below.
double weighted_median(const ErrorMap& map) {
  std::vector<float> errors = map.errors;
  std::sort(errors.begin(), errors.end());
  double sum = 0.0, below = 0.0;
  for (float e : errors) sum += e;
  for (float e : errors) {
    below += e;
    if (below > 0.5 * sum) return e;
  }
  return 0.0;
}

Image constant(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image image{width, height, 3, {}};
  for (int i = 0; i < width * height; ++i) image.pixels.insert(image.pixels.end(), {r, g, b});
  return image;
}

TEST(Flip, AgreesWithTheAuthorsProgram) {
  const nlohmann::json pairs = expected();
  const Image reference = read_image(kData / "ref.png");
  int compared = 0;
  for (const auto& [name, values] : pairs["ldr"].items()) {
    const ErrorMap map =
        flip(reference, read_image(kData / (name == "identical.png" ? "ref.png" : name)));
    EXPECT_NEAR(mean_error(map), values["flip_mean"].get<double>(), kMeanTolerance) << name;
    EXPECT_NEAR(*std::max_element(map.errors.begin(), map.errors.end()),
                values["flip_max"].get<double>(), kPixelTolerance)
        << name;
    EXPECT_NEAR(weighted_median(map), values["flip_median"].get<double>(), kPixelTolerance) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 6);
}

TEST(FlipHdr, AgreesWithTheAuthorsProgram) {
  const nlohmann::json pairs = expected();
  const FloatImage reference = read_float_image(kData / "hdr_ref.exr");
  const Exposures exposures = hdr_exposures(reference);
  for (const auto& [name, values] : pairs["hdr"].items()) {
    EXPECT_NEAR(exposures.first, values["start_exposure"].get<double>(), 1e-4);
    EXPECT_NEAR(exposures.last, values["stop_exposure"].get<double>(), 1e-4);
    EXPECT_EQ(exposures.count, values["num_exposures"].get<int>());
    const ErrorMap map = flip_hdr(reference, read_float_image(kData / name), exposures);
    EXPECT_NEAR(mean_error(map), values["flip_mean"].get<double>(), kMeanTolerance) << name;
    EXPECT_NEAR(weighted_median(map), values["flip_median"].get<double>(), kPixelTolerance) << name;
  }
}

TEST(Flip, OfGreenAndBlueIsOne) {
  // The pair that the colour error is scaled by.
  const ErrorMap map = flip(constant(8, 8, 0, 255, 0), constant(8, 8, 0, 0, 255));
  for (float error : map.errors) EXPECT_NEAR(error, 1.0f, 1e-5f);
}

TEST(Flip, LooksOnlyUnderTheMask) {
  const Image a = constant(60, 4, 9, 9, 9);
  Image b = a;
  for (int y = 0; y < 4; ++y) b.at(0, y)[0] = 200;
  Image mask{60, 4, 1, std::vector<std::uint8_t>(240, 0)};
  for (int y = 0; y < 4; ++y) mask.at(50, y)[0] = 255;
  const ErrorMap map = flip(a, b);
  EXPECT_GT(mean_error(map), 0.01);
  EXPECT_EQ(mean_error(map, &mask), 0.0) << "farther away than the filters reach";
  const Image nothing{60, 4, 1, std::vector<std::uint8_t>(240, 0)};
  EXPECT_THROW(mean_error(map, &nothing), std::invalid_argument);
}

TEST(Flip, RefusesOtherSizesAndViewersOutOfRange) {
  const Image a = constant(4, 4, 0, 0, 0);
  EXPECT_THROW(flip(a, constant(4, 5, 0, 0, 0)), std::invalid_argument);
  EXPECT_THROW(flip(a, a, 0.0), std::invalid_argument);
  EXPECT_THROW(flip(a, a, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
}

TEST(FlipHdr, StaysFiniteForBlackHugeAndNegativeLight) {
  FloatImage a{3, 1, std::vector<float>(9, 0.0f)}, b = a;
  b.pixels = {std::numeric_limits<float>::max(), 0.0f, 0.0f, -5.0f, -5.0f, -5.0f, 1.0f, 1.0f, 1.0f};
  for (const auto& [reference, test] : {std::pair{a, b}, std::pair{b, a}}) {
    const Exposures exposures = hdr_exposures(reference);
    EXPECT_LE(exposures.count, 200);
    for (float error : flip_hdr(reference, test, exposures).errors) {
      EXPECT_GE(error, 0.0f);
      EXPECT_LE(error, 1.0f);
    }
  }
}

TEST(ErrorPicture, GoesFromBlackToLightYellow) {
  // Ends of the colour map "magma".
  const Image picture = error_picture({2, 1, {0.0f, 1.0f}});
  EXPECT_LT(picture.at(0, 0)[0] + picture.at(0, 0)[1] + picture.at(0, 0)[2], 12);
  EXPECT_GT(picture.at(1, 0)[0], 250);
  EXPECT_GT(picture.at(1, 0)[1], 250);
  EXPECT_NEAR(picture.at(1, 0)[2], 191, 3);
}

}  // namespace
}  // namespace gnomon::ar
