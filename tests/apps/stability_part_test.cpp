// What sweeps found, as files, and where a method gives up. Oracles: what was written; closed
// forms.
#include "apps/study/stability_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/study/stability.h"
#include "ar/error.h"
#include "tests/apps/program.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::apps::study {
namespace {

/// Wrong are `value` of ten thousand for the first method, none for the second.
class Counting final : public Sweep {
 public:
  explicit Counting(std::string name) : name_(std::move(name)) {}
  SweepText text() const override {
    return {name_, "title", "explanation", "parameter", "wrong", "closed form"};
  }
  std::vector<std::string> values() const override { return {"0", "99", "100", "50", "200"}; }
  std::vector<std::string> methods() const override { return {"a", "b"}; }
  std::size_t inputs() const override { return 2; }
  std::vector<Outcome> run(std::size_t value, std::size_t input) override {
    return {{std::stod(values()[value]) + static_cast<double>(input), 10'000.0, 0},
            {0.0, 10'000.0, 0}};
  }

 private:
  std::string name_;
};

Sweeps two_sweeps() {
  Sweeps sweeps;
  sweeps.push_back(std::make_unique<Counting>("first"));
  sweeps.push_back(std::make_unique<Counting>("second"));
  return sweeps;
}

TEST(Stability, PartsPutTogetherAreTheWholeRunToTheByte) {
  const ar::TemporaryFolder folder;
  const auto run = [&](const char* name, const Shard& shard) {
    return run_stability(two_sweeps(), shard, folder.path() / name, [](std::size_t) {});
  };
  write_stability(folder.path() / "whole", run("whole", {}));
  for (const std::size_t number : {3, 1, 2}) run("parts", {number, 3});
  merge_stability(folder.path() / "parts");
  for (const char* file : {"stability.json", "stability.csv", "stability.html"})
    EXPECT_EQ(text_of(folder.path() / "whole" / file), text_of(folder.path() / "parts" / file))
        << file;
}

TEST(Stability, AMethodGivesUpWhereItDoesNotComeBack) {
  const ar::TemporaryFolder folder;
  const StabilityPart part =
      run_stability(two_sweeps(), {}, folder.path() / "out", [](std::size_t) {});
  EXPECT_EQ(inputs_of(part), 20u);
  const auto columns = columns_of(part, 0);
  ASSERT_EQ(columns.size(), 5u);
  // Both inputs' sum: 199 of 20,000 at "99", 201 at "100", and back at "50".
  EXPECT_EQ(border_of(columns, 0), 4u);
  EXPECT_EQ(border_of(columns, 1), 5u);
  EXPECT_DOUBLE_EQ(columns[2]->outcomes[0].share(), 201.0 / 20'000.0);
  EXPECT_DOUBLE_EQ(columns[2]->worst[0], 101.0 / 10'000.0);
}

}  // namespace
}  // namespace gnomon::apps::study
