// Oracles: synthetic brackets through a known curve, and response.json, the true curve of the
// rendered capture in examples/soft.
#include "ar/response_fit.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ar/error.h"
#include "ar/response.h"
#include "synthetic_brackets.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kSource = GNOMON_SOURCE_DIR;

/// Pixel values that a curve is off the true one, after the unit that brackets leave open has been
/// fitted in the middle.
double largest_error(const std::array<double, 256>& curve, const ResponseFunction& response,
                     const std::function<double(double)>& inverse, int low, int high) {
  const double unit = inverse(128.0 / 255.0) / curve[128];
  double largest = 0.0;
  for (int v = low; v <= high; ++v)
    largest = std::max(largest,
                       std::abs(255.0 * response(unit * curve[static_cast<std::size_t>(v)]) - v));
  return largest;
}

TEST(ResponseFit, FindsAGammaCurveFromCleanBrackets) {
  const auto radiance = [](int i, int c) { return ramp_radiance(i, 4096, c); };
  const std::vector<Brackets> sets{
      synthetic_brackets(64, 64, stops(8, 0.005, 2.0), radiance, gamma_response)};
  const ExposureCurve curve = fit_response(sets);
  for (const auto& channel : curve.exposure_from_value)
    EXPECT_LT(largest_error(
                  channel, gamma_response, [](double f) { return std::pow(f, 2.2); }, 4, 252),
              1.0);
}

TEST(ResponseFit, RisesStrictlyFromNothingToOne) {
  const auto radiance = [](int i, int c) { return ramp_radiance(i, 500, c); };
  const std::vector<Brackets> sets{
      synthetic_brackets(25, 20, stops(4, 0.01, 3.0), radiance, shoulder_response, 0.02)};
  const ExposureCurve curve = fit_response(sets);
  for (const auto& channel : curve.exposure_from_value) {
    EXPECT_EQ(channel[0], 0.0);
    EXPECT_EQ(channel[255], 1.0);
    EXPECT_TRUE(std::is_sorted(channel.begin(), channel.end(), std::less_equal<>()));
  }
}

// Two sets of other scenes and times share one curve; neither alone reaches all values.
TEST(ResponseFit, JoinsSetsOfDifferentScenes) {
  const auto dark = [](int i, int c) { return 0.02 + 0.0004 * ((i * 5 + c) % 400); };
  const auto bright = [](int i, int c) { return 0.3 + 0.008 * ((i * 5 + c) % 400); };
  const std::vector<Brackets> sets{
      synthetic_brackets(20, 20, stops(3, 0.05, 2.0), dark, shoulder_response),
      synthetic_brackets(20, 20, stops(4, 0.05, 1.6), bright, shoulder_response)};
  const ExposureCurve curve = fit_response(sets);
  const auto inverse = [](double f) { return std::pow(f / (1.42 - 0.42 * f), 1.0 / 0.56); };
  // The curve's smoothness is a guess that 800 pixels do not outweigh everywhere.
  EXPECT_LT(largest_error(curve.exposure_from_value[1], shoulder_response, inverse, 60, 240), 2.0);
}

TEST(ResponseFit, IsTheSameForAnyNumberOfThreads) {
  const auto radiance = [](int i, int c) { return ramp_radiance(i, 900, c); };
  const std::vector<Brackets> sets{
      synthetic_brackets(31, 29, stops(5, 0.01, 2.5), radiance, shoulder_response, 0.01)};
  const ExposureCurve one = fit_response(sets, {.threads = 1});
  for (const int threads : {2, 3, 7}) EXPECT_EQ(fit_response(sets, {.threads = threads}), one);
}

TEST(ResponseFit, NamesTheExposureWhoseTimeIsWrong) {
  const auto radiance = [](int i, int c) { return ramp_radiance(i, 4096, c); };
  Brackets set = synthetic_brackets(64, 64, stops(8, 0.005, 2.0), radiance, gamma_response);
  set.exposures[4].file = "fifth.png";
  set.exposures[4].time_s *= 1.9;
  try {
    fit_response({&set, 1});
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("fifth.png: its time is given as 0.152 s"));
  }
}

TEST(ResponseFit, RefusesExposuresThatShareNoValue) {
  // Black in one, saturated in the other.
  const Brackets set = synthetic_brackets(
      8, 8, {1e-6, 10.0}, [](int i, int) { return i % 2 == 0 ? 1.0 : 2.0; }, gamma_response);
  try {
    fit_response({&set, 1});
    FAIL() << "no error";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("synthetic.json: no pixel lies between black and saturation"));
  }
}

TEST(ResponseFit, FindsTheTrueCurveOfTheRenderedCapture) {
  const std::vector<Brackets> sets{
      read_brackets(kSource / "examples/soft/brackets/exposures.json"),
      read_brackets(kSource / "examples/soft/probe/brackets/exposures.json")};
  const ExposureCurve curve = fit_response(sets);
  const Response truth = read_response(kSource / "tests/data/soft/response.json");
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& table = truth.light_from_value[c];
    const double unit = static_cast<double>(table[128]) / curve.exposure_from_value[c][128];
    for (std::size_t v = 8; v <= 250; ++v) {
      const double got = unit * curve.exposure_from_value[c][v];
      // Within a value and a half of the truth.
      const double slope =
          (static_cast<double>(table[v + 1]) - static_cast<double>(table[v - 1])) / 2.0;
      EXPECT_NEAR(got, static_cast<double>(table[v]), 1.5 * slope)
          << "channel " << c << " value " << v;
    }
  }
}

}  // namespace
}  // namespace gnomon::ar
