#include "apps/study/sweep_views.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

std::size_t RandomNumbers::below(std::size_t count) {
  return static_cast<std::size_t>((std::uint64_t{words_()} * count) >> 32);
}

float RandomNumbers::signed_unit() { return static_cast<float>(words_() >> 8) * 0x1p-23f - 1.0f; }

glm::vec3 RandomNumbers::in_cube() {
  glm::vec3 p;
  for (int i = 0; i < 3; ++i) p[i] = signed_unit();
  return p;
}

std::vector<std::size_t> RandomNumbers::some_of(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::size_t taken = std::min(count, wanted);
  for (std::size_t i = 0; i < taken; ++i) std::swap(all[i], all[i + below(count - i)]);
  all.resize(taken);
  return all;
}

std::string number_text(double value) { return fmt::format("{:g}", value); }

std::vector<std::string> number_texts(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(number_text(value));
  return texts;
}

Scene ground_under(const glm::vec4& light, float half) {
  Scene scene;
  scene.objects.push_back({.name = "ground", .model = model_of(square_mesh(half)), .casts = false});
  scene.lights.push_back({.name = "light", .position = light});
  return scene;
}

void add_object(Scene& scene, const char* name, std::shared_ptr<const Model> model,
                const glm::mat4& place) {
  scene.objects.push_back({.name = name, .model = std::move(model), .world_from_model = place});
}

Scene box_under_lamp() {
  Scene scene = ground_under({0.1f, 4.0f, 0.2f, 1.0f});
  add_object(scene, "box", model_of(box_mesh({0.6f, 0.1f, 0.6f})), placed({0.0f, 1.6f, 0.0f}));
  add_object(scene, "ball", model_of(icosphere_mesh(0.3f, 3)), placed({0.3f, 0.3f, -1.2f}));
  add_object(scene, "torus", model_of(torus_mesh(0.35f, 0.12f, 24, 12)),
             placed({-0.8f, 0.4f, -1.8f}, {1.0f, 0.0f, 0.0f}, 0.9f));
  return scene;
}

Camera look_from_side(std::size_t number, const glm::vec3& at, float distance_m) {
  // The golden angle, so that any number of sides differ.
  const float angle = 0.4f + 2.399963f * static_cast<float>(number);
  const float rise = 0.45f + 0.13f * static_cast<float>(number % 3);
  const glm::vec3 side(std::cos(angle), rise, std::sin(angle));
  return look(at + distance_m * glm::normalize(side), at, kSweepWidth, kSweepHeight);
}

}  // namespace gnomon::apps::study
