#include "pipeline/intensity_transfer.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

TEST(ToneCurve, OfAGammaIsThePowerAtItsTablesEntries) {
  const ToneCurve tone = ToneCurve::from_gamma(2.2, 3.0);
  for (int v = 0; v < 256; ++v) {
    const double radiance = 3.0 * std::pow(v / 255.0, 2.2);
    EXPECT_NEAR(tone.value(1, radiance), v, 2e-3) << v;
    EXPECT_NEAR(tone.radiance(1, v), radiance, 1e-6);
  }
}

TEST(ToneCurve, GoesThereAndBack) {
  const ToneCurve tone = ToneCurve::from_gamma(1.8, 0.7);
  for (double value = 0.0; value <= 255.0; value += 0.37)
    EXPECT_NEAR(tone.value(2, tone.radiance(2, value)), value, 1e-3);
}

TEST(ToneCurve, ClampsWhatNoPixelCanShow) {
  const ToneCurve tone = ToneCurve::from_gamma(2.2, 3.0);
  EXPECT_EQ(tone.value(0, -1.0), 0.0);
  EXPECT_EQ(tone.value(0, std::numeric_limits<double>::quiet_NaN()), 0.0);
  EXPECT_EQ(tone.value(0, 1e30), 255.0);
  EXPECT_EQ(tone.value(0, std::numeric_limits<double>::infinity()), 255.0);
  EXPECT_EQ(tone.radiance(0, 300.0), tone.radiance(0, 255.0));
  EXPECT_THROW(ToneCurve::from_gamma(0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(ToneCurve::from_gamma(2.2, 0.0), std::invalid_argument);
}

struct Sources {
  ToneCurve tone = ToneCurve::from_gamma(2.2, 1.0);
  glm::dvec3 light{0.6, 0.5, 0.4};
  std::vector<glm::vec3> transfers;
  std::vector<std::uint8_t> sets;
  std::vector<glm::vec3> values;

  explicit Sources(std::size_t count) {
    std::mt19937 random(5);
    for (std::size_t j = 0; j < count; ++j) {
      transfers.push_back(glm::vec3(test::uniform(random, 0.1f, 1.0f) / static_cast<float>(count)) *
                          glm::vec3(0.6f, 0.5f, 0.4f));
      sets.push_back(in_first_set(j) ? 1 : 0);
    }
    values.resize(count);
    intensity_transfers(tone, light, transfers, sets, values);
  }
};

// Oracle: equation 3 with the visibility that was assumed.
TEST(IntensityTransfers, AreExactWhereTheAssumedSetIsHidden) {
  const Sources s(50);
  for (const int set : {0, 1}) {
    glm::dvec3 taken(0.0), left = s.light;
    for (std::size_t j = 0; j < s.transfers.size(); ++j) {
      if (s.sets[j] != set) continue;
      taken += glm::dvec3(s.values[j]);
      left -= glm::dvec3(s.transfers[j]);
    }
    const glm::dvec3 expected = s.tone.value(s.light) - s.tone.value(left);
    EXPECT_NEAR(taken.x, expected.x, 1e-3);
    EXPECT_NEAR(taken.y, expected.y, 1e-3);
    EXPECT_NEAR(taken.z, expected.z, 1e-3);
  }
}

TEST(IntensityTransfers, OfALinearResponseAreTheTransfersThemselves) {
  Sources s(20);
  s.tone = ToneCurve::from_gamma(1.0, 1.0);
  intensity_transfers(s.tone, s.light, s.transfers, s.sets, s.values);
  for (std::size_t j = 0; j < s.values.size(); ++j)
    EXPECT_NEAR(s.values[j].x, 255.0f * s.transfers[j].x, 1e-3f);
}

TEST(IntensityTransfers, TakeNoMoreThanThereIs) {
  Sources s(10);
  for (glm::vec3& transfer : s.transfers) transfer = glm::vec3(1.0f);
  intensity_transfers(s.tone, s.light, s.transfers, s.sets, s.values);
  for (const int set : {0, 1}) {
    double sum = 0.0;
    for (std::size_t j = 0; j < s.values.size(); ++j) {
      EXPECT_GE(s.values[j].x, 0.0f);
      if (s.sets[j] == set) sum += static_cast<double>(s.values[j].x);
    }
    EXPECT_LE(sum, s.tone.value(0, s.light.x) + 1e-3);
  }
  intensity_transfers(s.tone, s.light, {}, {}, {});
}

TEST(IntensityTransfers, SetsHoldTheShareThatIsAskedForAndDoNotChange) {
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    int first = 0;
    for (std::uint64_t j = 0; j < 10'000; ++j) first += in_first_set(j, share) ? 1 : 0;
    EXPECT_NEAR(first / 10'000.0, share, share > 0.0 && share < 1.0 ? 0.02 : 0.0);
  }
  EXPECT_TRUE(in_first_set(0) == in_first_set(0));
}

}  // namespace
}  // namespace gnomon::pipeline
