#include "tests/ar/model_checks.h"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

namespace gnomon::ar::test {

void expect_sound_mesh(const pipeline::Mesh& mesh) {
  EXPECT_EQ(mesh.indices.size() % 3, 0u);
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  EXPECT_TRUE(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
  for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
  for (const glm::vec4& p : mesh.positions)
    ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && p.w == 1.0f);
  for (const glm::vec3& n : mesh.normals) ASSERT_NEAR(glm::length(n), 1.0f, 1e-5f);
}

double volume6(const pipeline::Model& model) {
  double volume = 0.0;
  for (const pipeline::Part& part : model.parts) {
    const auto at = [&](std::size_t i) {
      return glm::dvec3(part.mesh.positions[part.mesh.indices[i]]);
    };
    for (std::size_t i = 0; i < part.mesh.indices.size(); i += 3)
      volume += glm::dot(at(i), glm::cross(at(i + 1), at(i + 2)));
  }
  return volume;
}

}  // namespace gnomon::ar::test
