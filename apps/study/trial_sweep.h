// A sweep whose inputs are views of a light's shadow, held against rays. Where a method's contract
// refuses an input (std::invalid_argument), all its pixels count as wrong.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/study/shadow_setting.h"
#include "apps/study/shadow_trial.h"
#include "apps/study/sweep.h"

namespace gnomon::apps::study {

class TrialSweep final : public Sweep {
 public:
  struct Plan {
    SweepText text;
    std::vector<std::string> values;
    std::size_t inputs = 1;
    std::vector<ShadowSetting> settings;
    /// The view of a value and an input.
    std::function<View(std::size_t value, std::size_t input)> view;
    /// Changes a setting for a value; may be empty.
    std::function<void(std::size_t value, ShadowSetting& setting)> adapt;
  };
  TrialSweep(Plan plan, int threads) : plan_(std::move(plan)), threads_(threads) {}

  SweepText text() const override { return plan_.text; }
  std::vector<std::string> values() const override { return plan_.values; }
  std::vector<std::string> methods() const override;
  std::size_t inputs() const override { return plan_.inputs; }
  std::vector<Outcome> run(std::size_t value, std::size_t input) override;

 private:
  Plan plan_;
  int threads_;
};

/// What most sweeps compare: z-pass and z-fail to infinity, the automatic choice, degenerate quads,
/// volumes for closed manifolds only, saturating counts, a map of 1024, and the alias-free map.
std::vector<ShadowSetting> swept_settings();

}  // namespace gnomon::apps::study
