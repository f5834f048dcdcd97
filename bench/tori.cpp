#include "bench/tori.h"

#include <cmath>
#include <memory>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace gnomon::bench {
namespace {

constexpr float kMajor_m = 0.3f, kMinor_m = 0.1f;
constexpr glm::vec4 kLight{2.0f, 6.0f, 3.0f, 1.0f};

raster::Material matt(const glm::vec3& color) {
  raster::Material material;
  material.ambient = material.diffuse = color;
  return material;
}

std::shared_ptr<const pipeline::Model> torus(Tessellation tessellation) {
  auto model = std::make_shared<pipeline::Model>();
  pipeline::Part part{.material = matt({0.8f, 0.5f, 0.3f})};
  const auto [ring, tube] = tessellation;
  for (int i = 0; i < ring; ++i) {
    const double u = glm::radians(360.0 * i / ring);
    for (int j = 0; j < tube; ++j) {
      const double v = glm::radians(360.0 * j / tube);
      const glm::dvec3 normal{std::cos(v) * std::cos(u), std::sin(v), std::cos(v) * std::sin(u)};
      const glm::dvec3 middle{std::cos(u), 0.0, std::sin(u)};
      part.mesh.positions.emplace_back(
          glm::vec3(middle * double{kMajor_m} + normal * double{kMinor_m}), 1.0f);
      part.mesh.normals.emplace_back(normal);
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % ring) * tube + j % tube);
  };
  for (int i = 0; i < ring; ++i) {
    for (int j = 0; j < tube; ++j) {
      const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      for (const std::uint32_t index : {a, c, b, a, d, c}) part.mesh.indices.push_back(index);
    }
  }
  model->parts.push_back(std::move(part));
  return model;
}

std::shared_ptr<const pipeline::Model> ground() {
  auto model = std::make_shared<pipeline::Model>();
  pipeline::Part part{.material = matt(glm::vec3(0.8f))};
  part.mesh.positions = {{-6, 0, -6, 1}, {6, 0, -6, 1}, {6, 0, 6, 1}, {-6, 0, 6, 1}};
  part.mesh.normals.assign(4, {0, 1, 0});
  part.mesh.indices = {0, 2, 1, 0, 3, 2};
  model->parts.push_back(std::move(part));
  return model;
}

}  // namespace

glm::mat4 spiral_place(int number) {
  const float angle = 2.399f * static_cast<float>(number);
  const float radius = 0.35f * std::sqrt(static_cast<float>(number));
  const glm::vec3 at{radius * std::cos(angle), 0.6f + 0.25f * static_cast<float>(number % 4),
                     radius * std::sin(angle)};
  return glm::translate(glm::mat4(1.0f), at) *
         glm::rotate(glm::mat4(1.0f), angle, glm::normalize(glm::vec3(1.0f, 0.3f, 0.2f)));
}

pipeline::Scene ground_scene() {
  pipeline::Scene scene;
  scene.ambient = glm::vec3(0.2f);
  scene.objects.push_back({.name = "ground", .model = ground(), .casts = false});
  scene.lights.push_back({.name = "lamp", .position = kLight});
  return scene;
}

pipeline::Scene tori_scene(int count, Tessellation tessellation) {
  pipeline::Scene scene = ground_scene();
  const auto model = torus(tessellation);
  for (int i = 0; i < count; ++i) {
    scene.objects.push_back({.name = "torus " + std::to_string(i),
                             .model = model,
                             .world_from_model = spiral_place(i)});
  }
  return scene;
}

pipeline::Camera tori_camera(int width, int height) {
  const glm::vec3 eye{0.0f, 2.2f, 4.2f};
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  return {
      .clip_from_world = glm::infinitePerspective(glm::radians(50.0f), aspect, 0.1f) *
                         glm::lookAt(eye, glm::vec3(0.0f, 0.4f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)),
      .eye_world = eye,
      .width = width,
      .height = height};
}

pipeline::Camera light_camera(int width, int height) {
  const glm::vec3 eye(kLight);
  return {
      .clip_from_world = glm::perspective(glm::radians(36.0f), 1.0f, 1.0f, 12.0f) *
                         glm::lookAt(eye, glm::vec3(0.0f, 0.9f, 0.0f), glm::vec3(0.0f, 1.0f, 0.0f)),
      .eye_world = eye,
      .width = width,
      .height = height};
}

}  // namespace gnomon::bench
