// Sweeps that need photographs. Oracles: the same scene with nothing changed, pictures that nothing
// is seen in, and another number of threads.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/study/photograph_sweeps.h"

using namespace gnomon;
using namespace gnomon::apps::study;
using ::testing::Each;
using ::testing::Field;
using ::testing::Not;

namespace {

const std::filesystem::path kExamples = GNOMON_SOURCE_DIR "/examples";

Sweeps sweeps(int threads = 1) {
  Sweeps all;
  add_photograph_sweeps(all, kExamples, threads);
  return all;
}

Sweep& named(const Sweeps& all, const std::string& name) {
  const auto found =
      std::ranges::find_if(all, [&](const auto& sweep) { return sweep->text().name == name; });
  EXPECT_NE(found, all.end()) << name;
  return **found;
}

const auto kNothingWrong = Field("wrong", &Outcome::wrong, 0.0);

class SweptFromNothing : public ::testing::TestWithParam<const char*> {};

std::string sweep_name(const ::testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

}  // namespace

TEST_P(SweptFromNothing, HasNothingWrongAtItsFirstValue) {
  const Sweeps all = sweeps();
  Sweep& sweep = named(all, GetParam());
  const std::vector<Outcome> outcomes = sweep.run(0, 0);
  EXPECT_EQ(outcomes.size(), sweep.methods().size());
  EXPECT_THAT(outcomes, Each(kNothingWrong));
  EXPECT_THAT(outcomes, Not(Each(Field("of", &Outcome::of, 0.0))));
}

INSTANTIATE_TEST_SUITE_P(ArSweeps, SweptFromNothing,
                         ::testing::Values("response-shadow", "response-pose", "phantom-coarse",
                                           "phantom-shifted", "phantom-missing", "light-shifted",
                                           "tags-noisy-lost", "tags-noisy-flicker",
                                           "tags-noisy-misplaced", "tags-blurred-lost",
                                           "tags-dark-lost", "tags-small-lost", "tags-covered-lost",
                                           "tags-gamma-lost", "tag-oblique-lost"),
                         sweep_name);

TEST(ArSweeps, OnePassByShareIsTheSameInValuesAndInRadiance) {
  const Sweeps all = sweeps();
  Sweep& sweep = named(all, "passes");
  const std::vector<std::string> methods = sweep.methods();
  const std::vector<Outcome> outcomes = sweep.run(0, 0);
  ASSERT_EQ(outcomes.size(), methods.size());
  for (std::size_t i = 0; i < methods.size(); ++i) {
    EXPECT_GT(outcomes[i].of, 0.0) << methods[i];
    if (methods[i] == "values, by share") {
      EXPECT_EQ(outcomes[i].wrong, 0.0);
    }
  }
}

TEST(ArSweeps, NamesAreDifferent) {
  std::vector<std::string> names;
  for (const auto& sweep : sweeps()) names.push_back(sweep->text().name);
  std::ranges::sort(names);
  EXPECT_EQ(std::ranges::adjacent_find(names), names.end());
}

TEST(ArSweeps, HopelessTagsLoseAllPictures) {
  const Sweeps all = sweeps();
  for (const char* name : {"tags-covered-lost", "tag-oblique-lost", "tags-small-lost"}) {
    Sweep& sweep = named(all, name);
    for (const Outcome& outcome : sweep.run(sweep.values().size() - 1, 0))
      EXPECT_EQ(outcome.share(), 1.0) << name;
  }
}

TEST(ArSweeps, LostPicturesAreWhollyWrong) {
  const Sweeps all = sweeps();
  for (const char* name : {"tag-oblique-flicker", "tag-oblique-misplaced"}) {
    Sweep& sweep = named(all, name);
    for (const Outcome& outcome : sweep.run(sweep.values().size() - 1, 0)) {
      EXPECT_GT(outcome.of, 0.0) << name;
      EXPECT_EQ(outcome.wrong, outcome.of) << name;
    }
  }
}

TEST(ArSweeps, TheFilterCalmsShadowsAtModerateNoise) {
  const Sweeps all = sweeps();
  Sweep& sweep = named(all, "tags-noisy-flicker");
  const std::vector<std::string> values = sweep.values();
  const auto five = static_cast<std::size_t>(std::ranges::find(values, "5") - values.begin());
  ASSERT_LT(five, values.size());
  for (std::size_t input = 0; input < sweep.inputs(); ++input) {
    const std::vector<Outcome> outcomes = sweep.run(five, input);
    EXPECT_LE(outcomes[0].share(), outcomes[1].share()) << input;
    EXPECT_GT(outcomes[1].share(), 0.0) << input;
  }
}

TEST(ArSweeps, TwoThreadsFindWhatOneFinds) {
  const Sweeps one = sweeps(1), two = sweeps(2);
  for (const char* name : {"passes", "response-shadow", "tags-noisy-misplaced", "phantom-coarse"}) {
    Sweep& first = named(one, name);
    const std::size_t value = first.values().size() / 2, input = first.inputs() - 1;
    EXPECT_EQ(first.run(value, input), named(two, name).run(value, input)) << name;
  }
}

TEST(ArSweeps, WithoutPhotographsThereAreNone) {
  EXPECT_TRUE(has_photographs(kExamples));
  EXPECT_FALSE(has_photographs(kExamples / "desk"));
}
