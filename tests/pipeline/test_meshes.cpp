#include "tests/pipeline/test_meshes.h"

#include <array>

#include <glm/geometric.hpp>

namespace gnomon::test {

float uniform(std::mt19937& random, float low, float high) {
  // The library's distributions differ between machines; 24 bits are what a float holds.
  return low + (high - low) * static_cast<float>(random() >> 8) / 16777216.0f;
}

unsigned below(std::mt19937& random, std::size_t count) {
  return static_cast<unsigned>(random() % count);
}

glm::vec3 uniform_point(std::mt19937& random, float low, float high) {
  const float x = uniform(random, low, high), y = uniform(random, low, high);
  return {x, y, uniform(random, low, high)};
}

pipeline::Mesh soup(std::mt19937& random) {
  pipeline::Mesh mesh;
  const unsigned points = 4 + below(random, 9), triangles = 1 + below(random, 30);
  for (unsigned i = 0; i < points; ++i) {
    mesh.positions.emplace_back(uniform_point(random, -1.0f, 1.0f), 1.0f);
  }
  for (unsigned i = 0; i < 3 * triangles; ++i) mesh.indices.push_back(below(random, points));
  return mesh;
}

pipeline::Scene random_scene(std::mt19937& random) {
  pipeline::Scene scene;
  scene.objects.push_back({.name = "plate",
                           .role = pipeline::Role::phantom,
                           .model = model_of(box_mesh({4.0f, 0.1f, 4.0f})),
                           .world_from_model = placed({0.0f, -0.1f, 0.0f})});
  const std::array<std::shared_ptr<const pipeline::Model>, 4> bodies = {
      model_of(box_mesh({0.5f, 0.5f, 0.5f})), model_of(torus_mesh(0.5f, 0.2f, 16, 8)),
      model_of(icosphere_mesh(0.5f, 1)), model_of(flat_box_mesh({0.6f, 0.2f, 0.4f}))};
  const unsigned count = 2 + below(random, 4);
  for (unsigned i = 0; i < count; ++i) {
    glm::vec3 at = uniform_point(random, -2.0f, 2.0f);
    at.y = uniform(random, 0.9f, 2.2f);
    glm::vec3 scale = uniform_point(random, 0.5f, 1.2f);
    if (below(random, 4) == 0) scale.x = -scale.x;
    const glm::vec3 axis = uniform_point(random, -1.0f, 1.0f) + glm::vec3(0.0f, 1e-3f, 0.0f);
    scene.objects.push_back(
        {.name = "body " + std::to_string(i),
         .role = i % 2 ? pipeline::Role::phantom : pipeline::Role::virtual_object,
         .model = bodies[below(random, bodies.size())],
         .world_from_model = placed(at, axis, uniform(random, 0.0f, 6.28f), scale)});
  }
  pipeline::Light light{.name = "lamp"};
  glm::vec3 position = uniform_point(random, -3.0f, 3.0f);
  position.y = uniform(random, 3.5f, 6.0f);
  const bool directional = below(random, 3) == 0;
  light.position =
      directional ? glm::vec4(glm::normalize(position), 0.0f) : glm::vec4(position, 1.0f);
  scene.lights.push_back(light);
  return scene;
}

}  // namespace gnomon::test
