#include "apps/study/camera_sweeps.h"

#include <fmt/format.h>

#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr const char* kWrongPixels = "wrong pixels of those that the light reaches";
constexpr const char* kRays = "Embree rays";

/// A box under a lamp, its shadow on the ground, and two bodies to look at.
Scene box_under_lamp() {
  Scene scene;
  scene.objects.push_back({.name = "ground", .model = model_of(square_mesh(4.0f)), .casts = false});
  scene.objects.push_back({.name = "box",
                           .model = model_of(box_mesh({0.6f, 0.1f, 0.6f})),
                           .world_from_model = placed({0.0f, 1.6f, 0.0f})});
  scene.objects.push_back({.name = "ball",
                           .model = model_of(icosphere_mesh(0.3f, 3)),
                           .world_from_model = placed({0.3f, 0.3f, -1.2f})});
  scene.objects.push_back(
      {.name = "torus",
       .model = model_of(torus_mesh(0.35f, 0.12f, 24, 12)),
       .world_from_model = placed({-0.8f, 0.4f, -1.8f}, {1.0f, 0.0f, 0.0f}, 0.9f)});
  scene.lights.push_back({.name = "lamp", .position = {0.1f, 4.0f, 0.2f, 1.0f}});
  return scene;
}

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
    return View{"", box_under_lamp(),
                look({x, height, 0.15f}, {0.4f * x, 0.3f, -1.5f}, kWidth, kHeight, 60.0f, 0.05f)};
  };
  return plan;
}

}  // namespace

void add_camera_sweeps(Sweeps& sweeps, int threads) {
  sweeps.push_back(std::make_unique<TrialSweep>(through_a_volume(), threads));
}

}  // namespace gnomon::apps::study
