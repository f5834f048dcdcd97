#include "apps/study/ray_case.h"

#include <utility>

namespace gnomon::apps::study {

RayCase::RayCase(View view, int threads)
    : view_(std::move(view)), threads_(threads), settings_(charted_settings()) {}

/// After the settings come the rays themselves.
std::size_t RayCase::settings() const { return settings_.size() + 1; }

Charted RayCase::run(std::size_t setting, int frames) {
  if (!trial_) trial_.emplace(view_, threads_);
  const bool is_rays = setting == settings_.size();
  const ShadowShot shot =
      is_rays ? trial_->run_rays(frames) : trial_->run(settings_[setting], frames);
  Charted out;
  out.point.scene = name();
  out.point.family = is_rays ? "rays" : settings_[setting].family;
  out.point.method = is_rays ? "Embree rays" : settings_[setting].name;
  out.point.oracle = "Embree rays";
  out.point.times = times_of(shot.times_ms);
  out.point.errors = {{"wrong pixels, % of those the light reaches", 100.0 * shot.wrong_share()}};
  out.picture = trial_->picture();
  out.difference = trial_->difference();
  return out;
}

}  // namespace gnomon::apps::study
