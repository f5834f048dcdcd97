#include "apps/study/ray_case.h"

#include <utility>

#include "apps/study/shadow_setting.h"

namespace gnomon::apps::study {

namespace {

constexpr const char* kRays = "Embree rays";

Charted charted(const ShadowTrial& trial, const ShadowShot& shot, std::string family,
                std::string method) {
  Charted out;
  out.point.scene = trial.view().name;
  out.point.family = std::move(family);
  out.point.method = std::move(method);
  out.point.oracle = kRays;
  out.point.errors = {{"wrong pixels, % of those the light reaches", 100.0 * shot.wrong_share()}};
  out.picture = trial.picture();
  out.difference = trial.difference();
  return out;
}

class Setting final : public Contender {
 public:
  Setting(ShadowTrial& trial, ShadowSetting setting)
      : trial_(trial), setting_(std::move(setting)) {}
  Charted measure() override {
    return charted(trial_, trial_.measure(setting_), setting_.family, setting_.name);
  }
  double frame_ms() override { return trial_.frame_ms(setting_); }

 private:
  ShadowTrial& trial_;
  ShadowSetting setting_;
};

class Rays final : public Contender {
 public:
  explicit Rays(ShadowTrial& trial) : trial_(trial) {}
  Charted measure() override { return charted(trial_, trial_.measure_rays(), "rays", kRays); }
  double frame_ms() override { return trial_.rays_ms(); }

 private:
  ShadowTrial& trial_;
};

}  // namespace

RayCase::RayCase(std::string name, std::function<View()> view, int threads)
    : name_(std::move(name)), view_(std::move(view)), threads_(threads) {}

std::vector<std::unique_ptr<Contender>> RayCase::contenders() {
  if (!trial_) {
    View view = view_();
    view.name = name_;
    trial_.emplace(std::move(view), threads_);
  }
  std::vector<std::unique_ptr<Contender>> out;
  for (ShadowSetting& setting : charted_settings())
    out.push_back(std::make_unique<Setting>(*trial_, std::move(setting)));
  out.push_back(std::make_unique<Rays>(*trial_));
  return out;
}

}  // namespace gnomon::apps::study
