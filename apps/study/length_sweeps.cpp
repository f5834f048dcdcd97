#include "apps/study/length_sweeps.h"

#include <memory>
#include <utility>
#include <vector>

#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

const std::vector<double> kRadius_m = {1e9, 1e6, 1000, 30,  10,  5,   3,    2,
                                       1.5, 1.2, 1,    0.8, 0.5, 0.2, 0.01, 1e-9};

View bodies_in_the_air(std::size_t input) {
  Scene scene = ground_under(input % 2 ? glm::vec4(0.36f, 0.8f, 0.48f, 0.0f)
                                       : glm::vec4(1.2f, 4.5f, 0.8f, 1.0f));
  add_object(scene, "ball", model_of(icosphere_mesh(0.35f, 3)), placed({-0.6f, 1.2f, 0.3f}));
  add_object(scene, "box", model_of(flat_box_mesh({0.4f, 0.1f, 0.5f})),
             placed({0.5f, 1.2f, 0.4f}, {0.1f, 1.0f, 0.2f}, 0.4f));
  add_object(scene, "torus", model_of(torus_mesh(0.5f, 0.15f, 24, 12)),
             placed({0.2f, 1.2f, -0.9f}, {1.0f, 0.0f, 0.0f}, 0.9f));
  return {"", std::move(scene), look_from_side(input, {-0.1f, 0.5f, -0.1f}, 4.5f)};
}

std::vector<ShadowSetting> radius_settings() {
  std::vector<ShadowSetting> out;
  for (const auto& [name, counting] :
       {std::pair{"z-pass, radius", VolumeMethod::zpass},
        std::pair{"z-fail, radius", VolumeMethod::zfail},
        std::pair{"automatic choice, radius", VolumeMethod::automatic},
        std::pair{"z-fail, degenerate quads, radius", VolumeMethod::zfail}})
    out.emplace_back(volumes(name, counting)).extrusion.kind = Extrusion::Kind::radius;
  out.back().geometry = VolumeGeometry::degenerate_quads;
  out.emplace_back(volumes("z-fail, as far as needed", VolumeMethod::zfail, false)).counts =
      Counts::everywhere;
  out.push_back(volumes("automatic volumes", VolumeMethod::automatic, false));
  out.push_back(volumes("z-fail to infinity", VolumeMethod::zfail));
  out.push_back(map("map 1024", 1024));
  out.push_back(alias_free());
  return out;
}

TrialSweep::Plan too_short() {
  TrialSweep::Plan plan;
  plan.text = {"volume-radius",
               "Volumes end before they reach the ground",
               "Bodies 1.2 m over the ground under a lamp and a light at infinity, in turns; their "
               "volumes end so far behind them. Beside them those that go to infinity or find how "
               "far.",
               "metres beyond the caster",
               kWrongPixels,
               kRays};
  plan.values = number_texts(kRadius_m);
  plan.inputs = 6;
  plan.settings = radius_settings();
  plan.view = [](std::size_t, std::size_t input) { return bodies_in_the_air(input); };
  plan.adapt = [](std::size_t value, ShadowSetting& setting) {
    if (setting.extrusion.kind == Extrusion::Kind::radius)
      setting.extrusion.radius_m = static_cast<float>(kRadius_m[value]);
  };
  return plan;
}

}  // namespace

void add_length_sweeps(Sweeps& sweeps, int threads) {
  sweeps.push_back(std::make_unique<TrialSweep>(too_short(), threads));
}

}  // namespace gnomon::apps::study
