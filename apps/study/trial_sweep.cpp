#include "apps/study/trial_sweep.h"

#include <stdexcept>

namespace gnomon::apps::study {

std::vector<std::string> TrialSweep::methods() const {
  std::vector<std::string> names;
  for (const ShadowSetting& setting : plan_.settings) names.push_back(setting.name);
  return names;
}

namespace {

/// What its contract refuses, a method gets wrong as a whole.
Outcome measured(ShadowTrial& trial, const ShadowSetting& setting) {
  const auto tested = static_cast<double>(trial.tested());
  try {
    const ShadowShot shot = trial.measure(setting);
    return {shot.wrong, tested, shot.not_finite};
  } catch (const std::invalid_argument&) {
    return {tested, tested, 0};
  }
}

}  // namespace

std::vector<Outcome> TrialSweep::run(std::size_t value, std::size_t input) {
  ShadowTrial trial(plan_.view(value, input), threads_);
  std::vector<Outcome> outcomes;
  for (ShadowSetting setting : plan_.settings) {
    if (plan_.adapt) plan_.adapt(value, setting);
    outcomes.push_back(measured(trial, setting));
  }
  return outcomes;
}

std::vector<ShadowSetting> swept_settings() {
  using pipeline::VolumeMethod;
  std::vector<ShadowSetting> out{volumes("z-pass", VolumeMethod::zpass),
                                 volumes("z-fail", VolumeMethod::zfail),
                                 volumes("automatic volumes", VolumeMethod::automatic, false)};
  ShadowSetting& quads = out.emplace_back(volumes("z-fail, degenerate quads", VolumeMethod::zfail));
  quads.geometry = pipeline::VolumeGeometry::degenerate_quads;
  out.emplace_back(volumes("z-fail, closed manifolds only", VolumeMethod::zfail)).classical = true;
  out.emplace_back(volumes("z-pass, saturating", VolumeMethod::zpass)).appendix_letter = true;
  out.push_back(map("map 1024", 1024));
  out.push_back(alias_free());
  return out;
}

}  // namespace gnomon::apps::study
