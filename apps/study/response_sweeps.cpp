#include "apps/study/response_sweeps.h"

#include <cmath>
#include <map>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "apps/study/picture_damage.h"
#include "apps/study/planned_sweep.h"
#include "ar/pose.h"

namespace gnomon::apps::study {

namespace {

using pipeline::ShadowPrecision;

/// Percent that the exponent is off, one way and the other.
constexpr double kOff_percent[] = {0, 1, 2, 5, 10, 15, 20};
constexpr std::size_t kWaysOff = 2;

std::vector<std::string> values() {
  std::vector<std::string> out;
  for (const double off : kOff_percent) out.push_back(fmt::format("{}", off));
  return out;
}

double exponent(std::size_t value, std::size_t way) {
  const double gamma = 1.0 + kOff_percent[value] / 100.0;
  return way == 0 ? gamma : 1.0 / gamma;
}

/// Radiances r become white (r / white)^gamma.
pipeline::ToneCurve bent(const pipeline::ToneCurve& tone, double gamma) {
  pipeline::ToneCurve out = tone;
  if (gamma == 1.0) return out;
  for (auto& channel : out.radiance_from_value) {
    const double white = channel.back();
    for (float& radiance : channel)
      radiance = static_cast<float>(white * std::pow(radiance / white, gamma));
  }
  return out;
}

/// About a step that shows at a shadow's edge; twice what rounding explains.
constexpr int kBound = 4;

struct Way {
  const char* name;
  ShadowPrecision precision;
  bool by_share;
};
constexpr Way kWays[] = {{"bytes, by share", ShadowPrecision::bytes, true},
                         {"radiance, by share", ShadowPrecision::radiance, true},
                         {"bytes, one amount (the paper)", ShadowPrecision::bytes, false},
                         {"radiance, one amount", ShadowPrecision::radiance, false}};

PlannedSweep::Plan of_shadows(const std::shared_ptr<SoftRoom>& room) {
  PlannedSweep::Plan plan;
  plan.text = {
      "response-shadow",
      "Shadows are subtracted with a wrong response curve",
      "Gibson's method with 50 passes on the room. The curve between radiance and values is bent "
      "by "
      "an exponent, up and down, after the light was found.",
      "percent that the exponent is off",
      fmt::format("pixels of the shadow that are off by more than {} values, of all of it", kBound),
      "the same method with the camera's own curve"};
  plan.values = values();
  for (const Way& way : kWays) plan.methods.emplace_back(way.name);
  plan.inputs = SoftRoom::kScenes * kWaysOff;
  plan.run = [room](std::size_t value, std::size_t input) {
    const std::size_t scene = input / kWaysOff;
    const std::vector<std::size_t>& region = room->shadow_region(scene);
    const pipeline::ToneCurve wrong = bent(room->lit().tone, exponent(value, input % kWaysOff));
    std::vector<Outcome> outcomes;
    for (const Way& way : kWays) {
      const pipeline::ShadowTakeOptions take{.precision = way.precision, .by_share = way.by_share};
      constexpr double kPowerShare = pipeline::TransferOptions{}.power_share;
      const SoftPicture truth = room->draw(scene, kPowerShare, take);
      const SoftPicture picture = room->draw(scene, kPowerShare, take, &wrong);
      outcomes.push_back({differing(picture, truth, region, kBound),
                          static_cast<double>(region.size()),
                          picture.not_finite + truth.not_finite});
    }
    return outcomes;
  };
  return plan;
}

/// Millimetres that a pose is off, of the way from the camera to the body.
void add_error(Outcome& sum, const std::optional<glm::dmat4>& measured, const glm::dmat4& truth) {
  const double way_mm = 1000.0 * glm::length(glm::dvec3(truth[3]));
  sum.of += way_mm;
  sum.wrong +=
      measured ? std::min(1000.0 * glm::distance(glm::dvec3((*measured)[3]), glm::dvec3(truth[3])),
                          way_mm)
               : way_mm;
}

PlannedSweep::Plan of_poses(const std::shared_ptr<Desk>& desk) {
  PlannedSweep::Plan plan;
  plan.text = {"response-pose",
               "Tags are measured with a wrong response curve",
               "The desk's photograph and two pictures of its video, their values bent by an "
               "exponent, up and down, but measured with the camera's own curve: where the tags "
               "put camera and bodies.",
               "percent that the exponent is off",
               "millimetres that poses are off, of the distance from the camera",
               "the poses in the pictures as they are"};
  plan.values = values();
  plan.methods = {"the world, four tags", "bodies with one tag each"};
  plan.inputs = (1 + Desk::kVideoPictures) * kWaysOff;
  plan.run = [desk](std::size_t value, std::size_t input) {
    const std::size_t picture = input / kWaysOff;
    DeskScene& scene = desk->scene(picture == 0 ? 0 : Desk::kStills + picture - 1);
    const ar::Image& clean = scene.photograph;
    const auto track = [&](const ar::Image& image) {
      return scene.tracker(image.width, image.height, false).update(image, 0.0);
    };
    const ar::TrackResult truth = track(clean);
    const ar::TrackResult found = track(study::bent(clean, exponent(value, input % kWaysOff)));
    std::vector<Outcome> outcomes(2);
    add_error(outcomes[0], found.world.camera_from_body, *truth.world.camera_from_body);
    for (std::size_t i = 0; i < truth.bodies.size(); ++i)
      if (truth.bodies[i].camera_from_body)
        add_error(outcomes[1], found.bodies[i].camera_from_body, *truth.bodies[i].camera_from_body);
    return outcomes;
  };
  return plan;
}

}  // namespace

void add_response_sweeps(Sweeps& sweeps, const std::shared_ptr<SoftRoom>& room,
                         const std::shared_ptr<Desk>& desk) {
  sweeps.push_back(std::make_unique<PlannedSweep>(of_shadows(room)));
  sweeps.push_back(std::make_unique<PlannedSweep>(of_poses(desk)));
}

}  // namespace gnomon::apps::study
