#include "apps/study/generated_views.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "apps/study/sweep_views.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

using ModelPointer = std::shared_ptr<const Model>;

void add(Scene& scene, const char* name, ModelPointer model, const glm::mat4& place) {
  scene.objects.push_back({.name = name + (" " + std::to_string(scene.objects.size())),
                           .model = std::move(model),
                           .world_from_model = place});
}

View closed_bodies(int width, int height) {
  Scene scene = ground_under({1.5f, 4.0f, 1.0f, 1.0f}, 4.0f);
  add(scene, "torus", model_of(torus_mesh(0.6f, 0.22f, 64, 32)),
      placed({-0.9f, 0.9f, 0.2f}, {1.0f, 0.0f, 0.3f}, 0.9f));
  add(scene, "ball", model_of(icosphere_mesh(0.45f, 4)), placed({0.6f, 0.7f, -0.3f}));
  add(scene, "box", model_of(flat_box_mesh({0.3f, 0.4f, 0.25f})),
      placed({0.4f, 0.4f, 1.1f}, {0.0f, 1.0f, 0.0f}, 0.6f));
  add(scene, "plate", model_of(flat_box_mesh({0.5f, 0.02f, 0.3f})),
      placed({-0.6f, 1.9f, -0.6f}, {0.4f, 0.0f, 1.0f}, 0.3f));
  return {"closed bodies", std::move(scene),
          look({2.2f, 2.4f, 3.2f}, {0.0f, 0.5f, 0.0f}, width, height)};
}

View many_casters(int width, int height) {
  Scene scene = ground_under({0.5f, 5.0f, 0.8f, 1.0f}, 5.0f);
  const ModelPointer torus = model_of(torus_mesh(0.25f, 0.09f, 32, 16));
  for (int i = 0; i < 40; ++i) {
    // A sunflower's spiral.
    const float angle = 2.399963f * static_cast<float>(i);
    const float far = 0.34f * std::sqrt(static_cast<float>(i) + 0.5f);
    add(scene, "torus", torus,
        placed({far * std::cos(angle), 0.5f + 0.02f * static_cast<float>(i), far * std::sin(angle)},
               {std::cos(angle), 0.2f, std::sin(angle)}, 1.1f));
  }
  return {"many casters", std::move(scene),
          look({2.4f, 2.6f, 3.2f}, {0.0f, 0.4f, 0.0f}, width, height)};
}

View thin_things(int width, int height) {
  Scene scene = ground_under(glm::vec4(glm::normalize(glm::vec3(1.0f, 0.22f, 0.35f)), 0.0f), 6.0f);
  const ModelPointer picket = model_of(flat_box_mesh({0.03f, 0.5f, 0.012f}));
  for (int i = 0; i < 24; ++i)
    add(scene, "picket", picket, placed({0.6f, 0.5f, -1.9f + 0.16f * static_cast<float>(i)}));
  add(scene, "rail", model_of(flat_box_mesh({0.01f, 0.03f, 2.0f})), placed({0.6f, 0.7f, 0.0f}));
  add(scene, "wire", model_of(torus_mesh(0.4f, 0.006f, 96, 8)),
      placed({1.6f, 0.45f, 0.8f}, {1.0f, 0.0f, 0.0f}, glm::half_pi<float>()));
  return {"thin things, low sun", std::move(scene),
          look({-3.2f, 1.9f, 2.2f}, {-0.6f, 0.1f, 0.1f}, width, height)};
}

View open_meshes(int width, int height) {
  Scene scene = ground_under({0.6f, 4.5f, 0.4f, 1.0f}, 4.0f);
  const ModelPointer leaf = model_of(square_mesh(0.3f));
  for (int i = 0; i < 9; ++i) {
    const float turn = 0.7f * static_cast<float>(i);
    scene.objects.push_back(
        {.name = "leaf " + std::to_string(i),
         .model = leaf,
         .world_from_model = placed(
             {1.1f * std::cos(turn), 0.6f + 0.12f * static_cast<float>(i), 1.1f * std::sin(turn)},
             {std::cos(2.0f * turn), 0.3f, std::sin(turn)}, 0.8f)});
  }
  Mesh open_box = flat_box_mesh({0.35f, 0.35f, 0.35f});
  open_box.indices.resize(open_box.indices.size() - 6);
  add(scene, "open box", model_of(std::move(open_box)),
      placed({0.0f, 0.6f, 0.0f}, {0.3f, 1.0f, 0.2f}, 0.5f));
  return {"open meshes", std::move(scene),
          look({2.0f, 2.2f, 2.8f}, {0.0f, 0.6f, 0.0f}, width, height)};
}

View eye_in_shadow(int width, int height) {
  Scene scene = ground_under({0.1f, 4.0f, 0.2f, 1.0f}, 4.0f);
  add(scene, "roof", model_of(flat_box_mesh({0.6f, 0.1f, 0.6f})), placed({0.0f, 1.6f, 0.0f}));
  add(scene, "ball", model_of(icosphere_mesh(0.3f, 4)), placed({0.3f, 0.3f, -1.2f}));
  add(scene, "torus", model_of(torus_mesh(0.35f, 0.12f, 48, 24)),
      placed({-0.8f, 0.4f, -1.8f}, {1.0f, 0.0f, 0.0f}, 0.9f));
  return {"eye in a shadow", std::move(scene),
          look({0.1f, 0.8f, 0.3f}, {0.0f, 0.3f, -1.5f}, width, height, 60.0f)};
}

View lamp_among_things(int width, int height) {
  Scene scene = ground_under({0.0f, 0.7f, 0.0f, 1.0f}, 4.0f);
  const ModelPointer pillar = model_of(flat_box_mesh({0.12f, 0.6f, 0.12f}));
  for (int i = 0; i < 7; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / 7.0f;
    add(scene, "pillar", pillar,
        placed({1.1f * std::cos(angle), 0.6f, 1.1f * std::sin(angle)}, {0.0f, 1.0f, 0.0f}, angle));
  }
  add(scene, "ring", model_of(torus_mesh(0.5f, 0.05f, 64, 16)), placed({0.0f, 1.3f, 0.0f}));
  return {"lamp among things", std::move(scene),
          look({2.6f, 2.9f, 2.6f}, {0.0f, 0.2f, 0.0f}, width, height)};
}

View wide_field(int width, int height) {
  Scene scene = ground_under(glm::vec4(glm::normalize(glm::vec3(0.4f, 1.0f, 0.25f)), 0.0f), 60.0f);
  const ModelPointer post = model_of(flat_box_mesh({0.06f, 0.5f, 0.06f}));
  const ModelPointer ball = model_of(icosphere_mesh(0.3f, 3));
  for (int i = 0; i < 60; ++i) {
    const float far = 0.8f * static_cast<float>(i);
    const float side = i % 2 ? 1.4f : -1.4f;
    add(scene, "post", post, placed({side, 0.5f, -far}));
    if (i % 4 == 0) add(scene, "ball", ball, placed({-0.3f * side, 0.35f, -far}));
  }
  return {"wide field, small casters", std::move(scene),
          look({0.0f, 1.6f, 3.0f}, {0.0f, 0.2f, -6.0f}, width, height, 50.0f, 0.1f, 200.0f)};
}

}  // namespace

std::vector<View> generated_views(int width, int height) {
  std::vector<View> views;
  for (View (*make)(int, int) : {closed_bodies, many_casters, thin_things, open_meshes,
                                 eye_in_shadow, lamp_among_things, wide_field})
    views.push_back(make(width, height));
  return views;
}

}  // namespace gnomon::apps::study
