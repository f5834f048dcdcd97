// A sweep that is put together of values and a function.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "apps/study/sweep.h"

namespace gnomon::apps::study {

class PlannedSweep final : public Sweep {
 public:
  struct Plan {
    SweepText text;
    std::vector<std::string> values, methods;
    std::size_t inputs = 1;
    /// As Sweep::run.
    std::function<std::vector<Outcome>(std::size_t value, std::size_t input)> run;
  };
  explicit PlannedSweep(Plan plan) : plan_(std::move(plan)) {}

  SweepText text() const override { return plan_.text; }
  std::vector<std::string> values() const override { return plan_.values; }
  std::vector<std::string> methods() const override { return plan_.methods; }
  std::size_t inputs() const override { return plan_.inputs; }
  std::vector<Outcome> run(std::size_t value, std::size_t input) override {
    return plan_.run(value, input);
  }

 private:
  Plan plan_;
};

}  // namespace gnomon::apps::study
