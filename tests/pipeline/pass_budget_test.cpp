#include "pipeline/pass_budget.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

/// Frames of a machine that needs base + slope * passes, give or take a twentieth.
double run(PassBudget& budget, int frames, double base_ms, double slope_ms, std::mt19937& random,
           double budget_ms, int* over = nullptr) {
  double last = 0.0;
  for (int i = 0; i < frames; ++i) {
    const std::size_t passes = budget.passes();
    last = (base_ms + slope_ms * static_cast<double>(passes)) *
           static_cast<double>(test::uniform(random, 0.95f, 1.05f));
    if (over && last > budget_ms) ++*over;
    budget.add(passes, last);
  }
  return last;
}

TEST(PassBudget, FillsTheBudgetAndHoldsIt) {
  std::mt19937 random(1);
  PassBudget budget(16.0, 500);
  run(budget, 30, 3.0, 0.2, random, 16.0);
  int over = 0;
  const double last = run(budget, 200, 3.0, 0.2, random, 16.0, &over);
  EXPECT_LE(over, 4);
  EXPECT_GT(last, 12.0);
  EXPECT_GT(budget.passes(), 45u);
}

TEST(PassBudget, FollowsASceneThatGrowsDearer) {
  std::mt19937 random(2);
  PassBudget budget(16.0, 500);
  run(budget, 50, 2.0, 0.1, random, 16.0);
  run(budget, 30, 4.0, 0.5, random, 16.0);
  int over = 0;
  run(budget, 100, 4.0, 0.5, random, 16.0, &over);
  EXPECT_LE(over, 3);
}

TEST(PassBudget, GoesNoHigherThanTheSourcesAndNoLowerThanOne) {
  std::mt19937 random(3);
  PassBudget cheap(16.0, 40);
  run(cheap, 40, 0.5, 0.01, random, 16.0);
  EXPECT_EQ(cheap.passes(), 40u);
  PassBudget dear(16.0, 40);
  run(dear, 40, 30.0, 5.0, random, 16.0);
  EXPECT_EQ(dear.passes(), 1u);
}

TEST(PassBudget, PassesOverTimesThatAreNone) {
  PassBudget budget(16.0, 100);
  const std::size_t before = budget.passes();
  budget.add(10, std::numeric_limits<double>::quiet_NaN());
  budget.add(10, -1.0);
  EXPECT_EQ(budget.passes(), before);
  EXPECT_THROW(PassBudget(0.0, 10), std::invalid_argument);
  EXPECT_THROW(PassBudget(16.0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::pipeline
