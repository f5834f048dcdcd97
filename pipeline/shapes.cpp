#include "pipeline/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace gnomon::pipeline {

Mesh box_mesh(const glm::vec3& half) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y,
                                i & 4 ? half.z : -half.z, 1.0f);
  }
  mesh.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return mesh;
}

Mesh flat_box_mesh(const glm::vec3& half) {
  const Mesh box = box_mesh(half);
  Mesh mesh;
  for (std::size_t i = 0; i < box.indices.size(); i += 3) {
    const glm::vec3 a(box.positions[box.indices[i]]), b(box.positions[box.indices[i + 1]]),
        c(box.positions[box.indices[i + 2]]);
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(box.positions[box.indices[i + k]]);
      mesh.normals.push_back(glm::normalize(glm::cross(b - a, c - a)));
    }
  }
  return mesh;
}

Mesh torus_mesh(float major, float minor, int around, int across) {
  Mesh mesh;
  const double turn = 2.0 * std::acos(-1.0);
  for (int i = 0; i < around; ++i) {
    const double a = turn * i / around;
    for (int j = 0; j < across; ++j) {
      const double b = turn * j / across;
      const glm::dvec3 normal(std::cos(b) * std::cos(a), std::sin(b), std::cos(b) * std::sin(a));
      const glm::dvec3 ring(major * std::cos(a), 0.0, major * std::sin(a));
      mesh.positions.emplace_back(glm::vec3(ring + static_cast<double>(minor) * normal), 1.0f);
      mesh.normals.emplace_back(normal);
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * across + j % across);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const std::uint32_t p = at(i, j), q = at(i, j + 1), r = at(i + 1, j + 1), s = at(i + 1, j);
      mesh.indices.insert(mesh.indices.end(), {p, q, r, p, r, s});
    }
  }
  return mesh;
}

Mesh icosphere_mesh(float radius, int levels) {
  const float g = (1.0f + std::sqrt(5.0f)) / 2.0f;
  std::vector<glm::vec3> points = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                   {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                   {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::uint32_t> indices = {0, 11, 5, 0, 5,  1,  0,  1,  7,  0,  7, 10, 0, 10, 11,
                                        1, 5,  9, 5, 11, 4,  11, 10, 2,  10, 7, 6,  7, 1,  8,
                                        3, 9,  4, 3, 4,  2,  3,  2,  6,  3,  6, 8,  3, 8,  9,
                                        4, 9,  5, 2, 4,  11, 6,  2,  10, 8,  6, 7,  9, 8,  1};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
      if (fresh) points.push_back(0.5f * (glm::normalize(points[a]) + glm::normalize(points[b])));
      return at->second;
    };
    std::vector<std::uint32_t> finer;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    indices = finer;
  }
  Mesh mesh;
  mesh.indices = indices;
  for (const glm::vec3& p : points) {
    const glm::vec3 normal = glm::normalize(p);
    mesh.positions.emplace_back(radius * normal, 1.0f);
    mesh.normals.push_back(normal);
  }
  return mesh;
}

Mesh square_mesh(float half) {
  Mesh mesh;
  mesh.positions = {
      {-half, 0, -half, 1}, {-half, 0, half, 1}, {half, 0, half, 1}, {half, 0, -half, 1}};
  mesh.normals.assign(4, {0.0f, 1.0f, 0.0f});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

std::shared_ptr<const Model> model_of(Mesh mesh) {
  auto model = std::make_shared<Model>();
  model->parts.push_back({.mesh = std::move(mesh)});
  return model;
}

glm::mat4 placed(const glm::vec3& at, const glm::vec3& axis, float angle, const glm::vec3& scale) {
  const glm::mat4 turned =
      glm::rotate(glm::translate(glm::mat4(1.0f), at), angle, glm::normalize(axis));
  return glm::scale(turned, scale);
}

Camera look(const glm::vec3& eye, const glm::vec3& at, int width, int height, float fov_y_deg,
            float near, float far) {
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const glm::vec3 forward = glm::normalize(at - eye);
  const glm::vec3 up = std::abs(forward.y) > 0.99f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  return {.clip_from_world = glm::perspective(glm::radians(fov_y_deg), aspect, near, far) *
                             glm::lookAt(eye, at, up),
          .eye_world = eye,
          .width = width,
          .height = height};
}

}  // namespace gnomon::pipeline
