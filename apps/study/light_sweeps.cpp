#include "apps/study/light_sweeps.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

std::vector<ShadowSetting> light_settings() {
  std::vector<ShadowSetting> out = swept_settings();
  ShadowSetting& radius = out.emplace_back(volumes("z-fail, radius 8 m", VolumeMethod::zfail));
  radius.extrusion = {Extrusion::Kind::radius, 8.0f};
  out.emplace_back(map("map 1024, near plane 0.1 m", 1024)).map.near_far_m = {0.1f, 20.0f};
  out.emplace_back(map("six maps of 512", 512)).map.sides = MapSides::six;
  return out;
}

/// The light's distance to a box's upper face.
const std::vector<double> kAboveBox_m = {3,    1,    0.3,  0.1, 0.03,  0.01,  1e-3, 1e-4,
                                         1e-5, 1e-6, 1e-7, 0,   -1e-7, -1e-4, -0.1};

View over_a_box(double above_m, std::size_t input) {
  // Its upper face is exactly at 1.25 m.
  constexpr glm::vec3 kHalf(0.5f, 0.25f, 0.375f);
  // Over the middle, over a triangle, and 1 mm from an edge and from a corner.
  constexpr glm::vec3 kOver[] = {
      {0.0f, 0.0f, 0.0f}, {0.2f, 0.0f, -0.1f}, {0.499f, 0.0f, 0.1f}, {0.499f, 0.0f, 0.374f}};
  const glm::vec3 at = kOver[input % 4] + glm::vec3(0.0f, static_cast<float>(1.25 + above_m), 0.0f);
  Scene scene = ground_under(glm::vec4(at, 1.0f));
  add_object(scene, "box", model_of(box_mesh(kHalf)), placed({0.0f, 1.0f, 0.0f}));
  // In the light as long as there is any; its own shadow would reach the eye.
  add_object(scene, "ball", model_of(icosphere_mesh(0.3f, 3)), placed({1.3f, 1.4f, 0.4f}));
  scene.objects.back().casts = false;
  add_object(scene, "torus", model_of(torus_mesh(0.35f, 0.12f, 24, 12)),
             placed({-0.3f, 0.3f, 0.2f}, {1.0f, 0.0f, 0.0f}, 0.5f));
  return {"", std::move(scene), look_from_side(input, {0.1f, 0.7f, 0.1f}, 4.5f)};
}

TrialSweep::Plan into_a_caster() {
  TrialSweep::Plan plan;
  plan.text = {
      "light-into-caster",
      "A lamp comes down on a box and goes into it",
      "A point light over the middle, over a triangle, and 1 mm from an edge and a corner of "
      "a box's upper face comes down to it and goes in, each seen from two sides. 1e-7 is one step "
      "of its float32; at 0 no triangle faces it. A map's own near plane of 0.1 m and a radius of "
      "8 m stand beside what is found.",
      "metres over the face",
      kWrongPixels,
      kRays};
  plan.values = number_texts(kAboveBox_m);
  plan.inputs = 8;
  plan.settings = light_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    return over_a_box(kAboveBox_m[value], input);
  };
  return plan;
}

const std::vector<double> kAboveSlab_m = {3,    1,    0.3,  0.1,   0.03, 0.01, 1e-3,
                                          1e-4, 1e-5, 1e-6, -1e-4, -0.1, -0.5, -3};

View over_a_slab(double above_m, std::size_t input) {
  RandomNumbers random(input);
  // One after the other: the order of arguments is the compiler's.
  const float z = 0.6f * random.signed_unit();
  const float x = 0.6f * random.signed_unit();
  const glm::vec3 at(x, static_cast<float>(above_m), z);
  Scene scene;
  scene.lights.push_back({.name = "light", .position = glm::vec4(at, 1.0f)});
  add_object(scene, "slab", model_of(box_mesh({4.0f, 0.125f, 4.0f})),
             placed({0.0f, -0.125f, 0.0f}));
  add_object(scene, "ball", model_of(icosphere_mesh(0.3f, 3)), placed({1.1f, 0.4f, 0.3f}));
  add_object(scene, "box", model_of(box_mesh({0.3f, 0.4f, 0.2f})),
             placed({-1.0f, 0.4f, -0.6f}, {0.0f, 1.0f, 0.0f}, 0.4f));
  add_object(scene, "torus", model_of(torus_mesh(0.4f, 0.12f, 24, 12)),
             placed({0.1f, 0.7f, -1.2f}, {1.0f, 0.0f, 0.0f}, 1.2f));
  return {"", std::move(scene), look_from_side(input, {0.0f, 0.4f, 0.0f}, 4.5f)};
}

TrialSweep::Plan behind_the_receiver() {
  TrialSweep::Plan plan;
  plan.text = {
      "light-behind-ground",
      "A lamp sinks into the ground and behind it",
      "A point light at six places comes down on a slab, 25 cm thick, that casts too, "
      "goes through it and ends under it, where all is in the slab's shadow. From 10 cm on "
      "the bodies' shadows rise to the eye.",
      "metres over the ground",
      kWrongPixels,
      kRays};
  plan.values = number_texts(kAboveSlab_m);
  plan.inputs = 6;
  plan.settings = light_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    return over_a_slab(kAboveSlab_m[value], input);
  };
  return plan;
}

/// A plate that stands on the ground, its large face towards +x before it is turned, and a ball in
/// the light behind it. Odd inputs have a light at infinity, others a lamp 4 m away.
View plate(const glm::vec3& light_in_plate, float lamp_m, float turned, std::size_t input) {
  const glm::mat4 place = placed({0.0f, 0.5f, 0.0f}, {0.0f, 1.0f, 0.0f}, turned);
  // A point of the large face's plane, so a lamp keeps its distance to it.
  const glm::vec3 from(lamp_m > 0.0f ? 0.125f : 0.0f, 0.0f, 0.0f);
  const glm::vec4 light = lamp_m > 0.0f ? place * glm::vec4(from + lamp_m * light_in_plate, 1.0f)
                                        : place * glm::vec4(light_in_plate, 0.0f);
  Scene scene = ground_under(light);
  add_object(scene, "plate", model_of(flat_box_mesh({0.125f, 0.5f, 0.75f})), place);
  add_object(scene, "ball", model_of(icosphere_mesh(0.25f, 3)),
             place * placed({0.4f, -0.25f, 1.2f}));
  const glm::vec3 eye(place * glm::vec4(2.6f, 1.6f + 0.2f * static_cast<float>(input % 3),
                                        1.5f - 0.7f * static_cast<float>(input % 4), 1.0f));
  return {"", std::move(scene), look(eye, {0.0f, 0.3f, 0.3f}, kSweepWidth, kSweepHeight)};
}

const std::vector<double> kGrazing_deg = {10, 3, 1, 0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 0};

TrialSweep::Plan grazing() {
  TrialSweep::Plan plan;
  plan.text = {"light-grazing",
               "A light grazes a plate's large face",
               "A lamp 4 m away and a light at infinity, in turns, at a smaller and smaller angle "
               "to the plane of the face that is seen; eight placements.",
               "degrees from the plane",
               kWrongPixels,
               kRays};
  plan.values = number_texts(kGrazing_deg);
  plan.inputs = 8;
  plan.settings = swept_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    const double angle = glm::radians(kGrazing_deg[value]), up = glm::radians(40.0);
    const glm::vec3 light(glm::dvec3(std::sin(angle), std::cos(angle) * std::sin(up),
                                     -std::cos(angle) * std::cos(up)));
    return plate(light, input % 2 ? 0.0f : 4.0f, 0.55f * static_cast<float>(input), input);
  };
  return plan;
}

const std::vector<double> kSteps = {1e6, 1e5, 1e4, 1000, 100, 10, 4, 3, 2, 1, 0};

TrialSweep::Plan in_the_plane() {
  TrialSweep::Plan plan;
  plan.text = {
      "light-in-plane",
      "A light is in a plate's plane but for some float steps",
      "A lamp and a light at infinity, in turns, so many steps of a float32 (2^-27 m, of "
      "a direction 2^-24) before or behind the plane of the large face that is seen; "
      "eight placements, half of them along the axes, where the coordinates are exact. Those "
      "that are turned round by some steps themselves, and so do the rays' corners.",
      "steps",
      kWrongPixels,
      kRays};
  plan.values = number_texts(kSteps);
  plan.inputs = 8;
  plan.settings = swept_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    const bool direction = input % 2 == 1, behind = input % 4 >= 2;
    const float turned = input < 4 ? 0.0f : 0.3f * static_cast<float>(input);
    const double step = direction ? 0x1p-24 : 0x1p-27 / 4.0;
    const auto across = static_cast<float>((behind ? -1.0 : 1.0) * step * kSteps[value]);
    // Exact: 3, 4, 5.
    return plate({across, 0.6f, -0.8f}, direction ? 0.0f : 4.0f, turned, input);
  };
  return plan;
}

}  // namespace

void add_light_sweeps(Sweeps& sweeps, int threads) {
  for (TrialSweep::Plan (*plan)() : {into_a_caster, behind_the_receiver, grazing, in_the_plane})
    sweeps.push_back(std::make_unique<TrialSweep>(plan(), threads));
}

}  // namespace gnomon::apps::study
