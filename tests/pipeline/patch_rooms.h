// Small closed and open rooms for tests of the light in them.
#pragma once

#include <array>
#include <memory>
#include <string>

#include <glm/vec3.hpp>

#include "pipeline/patches.h"
#include "pipeline/scene.h"

namespace gnomon {

/// A rectangle of two triangles as an object, its front where u x v points.
inline pipeline::Object rectangle(const std::string& name, glm::vec3 corner, glm::vec3 u,
                                  glm::vec3 v) {
  pipeline::Part part;
  for (const glm::vec3 p : {corner, corner + u, corner + u + v, corner + v})
    part.mesh.positions.emplace_back(p, 1.0f);
  part.mesh.indices = {0, 1, 2, 0, 2, 3};
  auto model = std::make_shared<pipeline::Model>();
  model->parts.push_back(std::move(part));
  pipeline::Object object;
  object.name = name;
  object.model = std::move(model);
  return object;
}

/// A cube from -1 to 1 whose six sides look inwards.
inline pipeline::Scene cube_room() {
  pipeline::Scene scene;
  scene.objects = {rectangle("left", {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}),
                   rectangle("right", {1, -1, -1}, {0, 0, 2}, {0, 2, 0}),
                   rectangle("floor", {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}),
                   rectangle("ceiling", {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}),
                   rectangle("back", {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}),
                   rectangle("front", {-1, -1, 1}, {0, 2, 0}, {2, 0, 0})};
  return scene;
}

}  // namespace gnomon
