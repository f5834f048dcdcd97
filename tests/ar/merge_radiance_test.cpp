// Oracle: the radiance that synthetic brackets were made of.
#include "ar/merge_radiance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "synthetic_brackets.h"

namespace gnomon::ar {
namespace {

ExposureCurve gamma_curve() {
  ExposureCurve curve;
  for (auto& channel : curve.exposure_from_value)
    for (std::size_t v = 0; v < 256; ++v)
      channel[v] = std::pow(static_cast<double>(v) / 255.0, 2.2);
  return curve;
}

TEST(MergeRadiance, GivesBackWhatTheBracketsWereMadeOf) {
  const auto radiance = [](int i, int c) { return ramp_radiance(i, 1000, c); };
  const Brackets set = synthetic_brackets(40, 25, stops(8, 0.005, 2.0), radiance, gamma_response);
  const MergedRadiance merged = merge_radiance(set, gamma_curve());
  EXPECT_EQ(merged.saturated, 0u);
  for (int i = 0; i < 1000; ++i)
    for (int c = 0; c < 3; ++c) {
      const double got =
          static_cast<double>(merged.picture.pixels[static_cast<std::size_t>(3 * i + c)]);
      // Values are rounded: the darkest pixels reach 26, where half a step is 4 % of the exposure.
      EXPECT_NEAR(got / radiance(i, c), 1.0, 0.045) << i;
    }
}

TEST(MergeRadiance, CountsWhatNoExposureTells) {
  const auto radiance = [](int i, int) { return i == 0 ? 1e-9 : i == 1 ? 1e9 : 1.0; };
  const Brackets set = synthetic_brackets(3, 1, {0.1, 0.2}, radiance, gamma_response);
  const MergedRadiance merged = merge_radiance(set, gamma_curve());
  EXPECT_EQ(merged.black, 1u);
  EXPECT_EQ(merged.saturated, 1u);
  EXPECT_EQ(merged.picture.at(0, 0)[0], 0.0f);
  // At least what saturates the shortest exposure.
  EXPECT_FLOAT_EQ(merged.picture.at(1, 0)[1], 10.0f);
  EXPECT_NEAR(merged.picture.at(2, 0)[2], 1.0f, 0.01f);
}

TEST(MergeRadiance, NoiseNearSaturationLeavesNoBias) {
  // A pixel just below saturation of the longest exposure: noise cuts off one side of it there.
  const auto radiance = [](int, int) { return 0.97; };
  const Brackets set =
      synthetic_brackets(100, 100, {0.25, 0.5, 1.0}, radiance, gamma_response, 0.03);
  const MergedRadiance merged = merge_radiance(set, gamma_curve());
  double sum = 0.0;
  for (const float v : merged.picture.pixels) sum += static_cast<double>(v);
  EXPECT_NEAR(sum / static_cast<double>(merged.picture.pixels.size()) / 0.97, 1.0, 0.01);
}

TEST(MergeRadiance, IsTheSameForAnyNumberOfThreads) {
  const auto radiance = [](int i, int c) { return ramp_radiance(i, 20000, c); };
  const Brackets set = synthetic_brackets(200, 100, stops(4, 0.005, 3.0), radiance, gamma_response);
  const auto one = merge_radiance(set, gamma_curve(), 1).picture.pixels;
  EXPECT_EQ(merge_radiance(set, gamma_curve(), 3).picture.pixels, one);
}

}  // namespace
}  // namespace gnomon::ar
