#include "apps/study/camera_sweeps.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

/// Metres from the volume's side plane into the shadow.
constexpr float kInto_m[] = {-0.8f, -0.4f, -0.2f, -0.1f, -0.05f, -0.02f, 0.0f,
                             0.02f, 0.05f, 0.1f,  0.2f,  0.4f,   0.8f};

TrialSweep::Plan through_a_volume() {
  TrialSweep::Plan plan;
  plan.text = {
      "camera-in-volume",
      "The camera flies into a shadow volume",
      "A camera with its near plane 5 cm before it goes sideways into the shadow of a box, "
      "at eight heights. From about 5 cm before the volume's side on the near plane cuts it.",
      "metres inside",
      kWrongPixels,
      kRays};
  for (const float into : kInto_m) plan.values.push_back(fmt::format("{:.2f}", into));
  plan.inputs = 8;
  plan.settings = swept_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    const float height = 0.15f + 0.15f * static_cast<float>(input);
    // The shadow's left side: a line from the lamp over the box's upper left edge.
    const float left = 0.1f + (-0.6f - 0.1f) * (4.0f - height) / (4.0f - 1.7f);
    const float x = left + kInto_m[value];
    return View{
        "", box_under_lamp(),
        look({x, height, 0.15f}, {0.4f * x, 0.3f, -1.5f}, kSweepWidth, kSweepHeight, 60.0f, 0.05f)};
  };
  return plan;
}

constexpr float kNear_m[] = {0.001f, 0.01f, 0.1f, 0.3f, 0.5f, 0.55f, 0.6f, 0.65f,
                             0.8f,   1.0f,  1.3f, 1.6f, 2.0f, 2.5f,  3.0f, 3.6f};

/// Its shadow at the camera's height is 0.6 to 1.6 m before it; the ground begins 2 m before it.
View before_a_volume(float near_m, std::size_t input) {
  Scene scene = ground_under({0.0f, 6.0f, -1.1f, 1.0f}, 8.0f);
  add_object(scene, "box", model_of(box_mesh({0.9f, 0.1f, 0.3f})), placed({0.0f, 3.0f, -1.1f}));
  add_object(scene, "wall", model_of(box_mesh({4.0f, 2.0f, 0.1f})), placed({0.0f, 2.0f, -4.5f}));
  add_object(scene, "ball", model_of(icosphere_mesh(0.4f, 3)), placed({-0.5f, 0.6f, -2.9f}));
  add_object(scene, "torus", model_of(torus_mesh(0.5f, 0.15f, 24, 12)),
             placed({0.7f, 0.6f, -3.0f}, {1.0f, 0.0f, 0.0f}, 0.9f));
  const float aside = 0.35f * (static_cast<float>(input % 4) - 1.5f);
  const float height = 1.2f + 0.1f * static_cast<float>(input / 4);
  return {"", std::move(scene),
          look({aside, height, 0.0f}, {-aside, height, -4.0f}, kSweepWidth, kSweepHeight, 60.0f,
               near_m)};
}

TrialSweep::Plan cut_by_the_near_plane() {
  TrialSweep::Plan plan;
  plan.text = {"near-plane",
               "The near plane reaches through a shadow volume",
               "A camera looks through a box's shadow, which begins 0.6 m before it, at eight "
               "places; its near plane goes from 1 mm through the shadow's 1 m. The eye stays "
               "outside, and up to 2 m no surface is before the plane; from there on surfaces "
               "share the depth 0.",
               "near plane in metres",
               kWrongPixels,
               kRays};
  for (const float near_m : kNear_m)
    plan.values.push_back(number_text(static_cast<double>(near_m)));
  plan.inputs = 8;
  plan.settings = swept_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    return before_a_volume(kNear_m[value], input);
  };
  return plan;
}

}  // namespace

void add_camera_sweeps(Sweeps& sweeps, int threads) {
  sweeps.push_back(std::make_unique<TrialSweep>(through_a_volume(), threads));
  sweeps.push_back(std::make_unique<TrialSweep>(cut_by_the_near_plane(), threads));
}

}  // namespace gnomon::apps::study
