// Oracle: closed forms.
#include "bench/statistics.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace gnomon::bench {
namespace {

TEST(Median, IsTheMiddleValueWhateverTheOrder) {
  EXPECT_EQ(median({5.0, 1.0, 4.0, 100.0, 2.0}), 4.0);
  EXPECT_EQ(median({7.0}), 7.0);
}

TEST(Median, IsTheMeanOfTheMiddleTwoOfAnEvenNumber) {
  EXPECT_EQ(median({4.0, 1.0, 100.0, 2.0}), 3.0);
}

TEST(Median, RefusesNoValues) { EXPECT_THROW(median({}), std::invalid_argument); }

TEST(Slope, IsTheExponentOfAPower) {
  std::vector<double> x, y;
  for (const double value : {1.0, 10.0, 35.0, 1000.0}) {
    x.push_back(value);
    y.push_back(3.0 * std::pow(value, 1.5));
  }
  // Logarithms of doubles: an error of some units in the last place of 1.5.
  EXPECT_NEAR(log_log_slope(x, y), 1.5, 1e-12);
}

TEST(Slope, OfPointsOffALineIsTheLeastSquaresOne) {
  // In logarithms to base 2: (0, 0), (1, 0), (2, 3); the line of least squares rises 3/2.
  const std::vector<double> x{1.0, 2.0, 4.0}, y{1.0, 1.0, 8.0};
  EXPECT_NEAR(log_log_slope(x, y), 1.5, 1e-12);
}

TEST(Slope, RefusesWhatHasNoLogarithmAndOneXAlone) {
  const std::vector<double> one{1.0, 1.0}, two{1.0, 2.0}, zero{0.0, 1.0};
  EXPECT_THROW(log_log_slope(one, two), std::invalid_argument);
  EXPECT_THROW(log_log_slope(zero, two), std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::bench
