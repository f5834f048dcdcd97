#include "apps/study/depth_sweeps.h"

#include <memory>
#include <utility>
#include <vector>

#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

constexpr double kFar_m = 150.0;
const std::vector<double> kRatios = {15, 30, 100, 300, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7};

/// Bodies from 14 to 110 m away, each as large in the picture as the others.
View long_street(double ratio, std::size_t input) {
  Scene scene = ground_under(
      input % 2 ? glm::vec4(30.0f, 45.0f, -20.0f, 1.0f) : glm::vec4(0.36f, 0.8f, 0.48f, 0.0f),
      150.0f);
  float away_m = 14.0f;
  for (int i = 0; i < 7; ++i, away_m *= 1.4f) {
    const float size = 0.05f * away_m, aside = (i % 2 ? 0.12f : -0.12f) * away_m;
    add_object(scene, "ball", model_of(icosphere_mesh(size, 3)),
               placed({aside, 1.3f * size, -away_m}));
    add_object(scene, "box", model_of(flat_box_mesh(glm::vec3(0.6f * size, size, 0.3f * size))),
               placed({-aside, size, -away_m}, {0.0f, 1.0f, 0.0f}, 0.7f * static_cast<float>(i)));
  }
  const float aside = 0.5f * static_cast<float>(input / 2);
  return {"", std::move(scene),
          look({aside, 5.0f, 0.0f}, {0.0f, 3.2f, -10.0f}, kSweepWidth, kSweepHeight, 30.0f,
               static_cast<float>(kFar_m / ratio), static_cast<float>(kFar_m))};
}

TrialSweep::Plan ratio_of_planes() {
  TrialSweep::Plan plan;
  plan.text = {"depth-ratio",
               "The camera's planes are far apart",
               "A street with bodies 14 to 110 m away under a lamp and a light at infinity, in "
               "turns, at four places. The far plane is at 150 m, the near one from 10 m to "
               "15 micrometres; depth has 24 bits or 16. Where surfaces themselves are mixed up, "
               "it counts too.",
               "far plane by near plane",
               kWrongPixels,
               kRays};
  plan.values = number_texts(kRatios);
  plan.inputs = 4;
  plan.settings = swept_settings();
  for (ShadowSetting setting : swept_settings()) {
    setting.name += ", D16";
    setting.depth = raster::DepthFormat::d16;
    plan.settings.push_back(std::move(setting));
  }
  plan.view = [](std::size_t value, std::size_t input) {
    return long_street(kRatios[value], input);
  };
  return plan;
}

const std::vector<double> kFarPlane_m = {100, 30, 15, 10, 8, 7, 6, 5.5, 5, 4.5, 4, 3.5, 3, 2.5};

View near_a_far_plane(double far_m, std::size_t input) {
  Scene scene = ground_under(input % 2 ? glm::vec4(0.36f, 0.8f, 0.48f, 0.0f)
                                       : glm::vec4(1.2f, 4.0f, 0.8f, 1.0f));
  add_object(scene, "box", model_of(flat_box_mesh({0.4f, 0.1f, 0.5f})),
             placed({0.2f, 1.4f, 0.1f}, {0.1f, 1.0f, 0.2f}, 0.4f));
  add_object(scene, "ball", model_of(icosphere_mesh(0.4f, 3)), placed({-0.6f, 0.5f, 0.5f}));
  add_object(scene, "torus", model_of(torus_mesh(0.5f, 0.15f, 24, 12)),
             placed({0.3f, 0.6f, -1.1f}, {1.0f, 0.0f, 0.0f}, 0.9f));
  Camera camera = look_from_side(input, {0.0f, 0.5f, 0.0f}, 4.5f);
  const glm::vec3 eye = camera.eye_world;
  return {"", std::move(scene),
          look(eye, {0.0f, 0.5f, 0.0f}, kSweepWidth, kSweepHeight, 50.0f, 0.05f,
               static_cast<float>(far_m))};
}

/// To infinity, as far as needed, and 6 m beyond the caster, which is through the ground.
std::vector<ShadowSetting> long_settings() {
  std::vector<ShadowSetting> out = swept_settings();
  out.emplace_back(volumes("z-fail, as far as needed", VolumeMethod::zfail, false)).counts =
      Counts::everywhere;
  const Extrusion radius{Extrusion::Kind::radius, 6.0f};
  out.emplace_back(volumes("z-pass, radius 6 m", VolumeMethod::zpass)).extrusion = radius;
  out.emplace_back(volumes("z-fail, radius 6 m", VolumeMethod::zfail)).extrusion = radius;
  ShadowSetting& quads =
      out.emplace_back(volumes("z-fail, degenerate quads, radius 6 m", VolumeMethod::zfail));
  quads.geometry = VolumeGeometry::degenerate_quads;
  quads.extrusion = radius;
  return out;
}

TrialSweep::Plan back_cap_beyond_far() {
  TrialSweep::Plan plan;
  plan.text = {"far-plane",
               "Volumes end beyond the far plane",
               "Bodies about 4.5 m away; volumes that end at infinity, as far as needed, or 6 m "
               "behind the body. The far plane comes closer than these ends, and from 6 m on "
               "through the ground and the bodies. Depth is clamped, so no cap is cut off; but "
               "what lies behind the far plane has the depth of what is cleared, 1: light is "
               "added to it, and no volume shadows it.",
               "far plane in metres",
               kWrongPixels,
               kRays};
  plan.values = number_texts(kFarPlane_m);
  plan.inputs = 6;
  plan.settings = long_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    return near_a_far_plane(kFarPlane_m[value], input);
  };
  return plan;
}

}  // namespace

void add_depth_sweeps(Sweeps& sweeps, int threads) {
  sweeps.push_back(std::make_unique<TrialSweep>(ratio_of_planes(), threads));
  sweeps.push_back(std::make_unique<TrialSweep>(back_cap_beyond_far(), threads));
}

}  // namespace gnomon::apps::study
