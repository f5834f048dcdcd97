#include "apps/study/pass_sweeps.h"

#include <fmt/format.h>

#include "apps/study/planned_sweep.h"

namespace gnomon::apps::study {

namespace {

using pipeline::ShadowPrecision;

constexpr std::size_t kPasses[] = {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000};
/// Every source, so that there are shadows for the most passes.
constexpr double kAllPower = 1.0;
/// Two roundings of one number are at most 1 apart; 2 is what a third one may add.
constexpr int kBound = 2;

struct Way {
  const char* name;
  ShadowPrecision precision;
  bool by_share;
};
constexpr Way kWays[] = {{"bytes, by share", ShadowPrecision::bytes, true},
                         {"dithered, by share", ShadowPrecision::dithered, true},
                         {"values, by share", ShadowPrecision::values, true},
                         {"bytes, one amount (the paper)", ShadowPrecision::bytes, false},
                         {"dithered, one amount", ShadowPrecision::dithered, false},
                         {"values, one amount", ShadowPrecision::values, false}};

std::vector<Outcome> run(SoftRoom& room, std::size_t value, std::size_t input) {
  const std::vector<std::size_t>& region = room.shadow_region(input);
  const auto draw = [&](ShadowPrecision precision, bool by_share) {
    return room.draw(input, kAllPower,
                     {.passes = kPasses[value], .precision = precision, .by_share = by_share});
  };
  const SoftPicture share = draw(ShadowPrecision::radiance, true);
  const SoftPicture amount = draw(ShadowPrecision::radiance, false);
  std::vector<Outcome> outcomes;
  for (const Way& way : kWays) {
    const SoftPicture& floats = way.by_share ? share : amount;
    const SoftPicture picture = draw(way.precision, way.by_share);
    outcomes.push_back({differing(picture, floats, region, kBound),
                        static_cast<double>(region.size()),
                        picture.not_finite + floats.not_finite});
  }
  return outcomes;
}

}  // namespace

void add_pass_sweeps(Sweeps& sweeps, const std::shared_ptr<SoftRoom>& room) {
  PlannedSweep::Plan plan;
  plan.text = {
      "passes",
      "Many faint shadows are subtracted in eight bits",
      "Gibson's method on the room, a box in the air and a head on the floor at two places each, "
      "with sources for all of the light's power: more and more shadows, each a smaller part of "
      "the same light. "
      "One amount is off before anything is rounded: it is taken as if half of the sources were "
      "hidden, and here all may be.",
      "passes",
      fmt::format("pixels of the shadow that are off by more than {} values, of all of it", kBound),
      "the same passes subtracted as radiance in floats"};
  for (const std::size_t passes : kPasses) plan.values.push_back(std::to_string(passes));
  for (const Way& way : kWays) plan.methods.emplace_back(way.name);
  plan.inputs = SoftRoom::kScenes;
  plan.run = [room](std::size_t value, std::size_t input) { return run(*room, value, input); };
  sweeps.push_back(std::make_unique<PlannedSweep>(std::move(plan)));
}

}  // namespace gnomon::apps::study
