// Oracles: the model itself, and the closed form of what a ball's reduction can be off by.
#include "pipeline/reduced_occluder.h"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

std::size_t triangles_of(const Model& model) {
  std::size_t count = 0;
  for (const Part& part : model.parts) count += part.mesh.triangle_count();
  return count;
}

TEST(ReducedOccluder, HasAtMostTheTrianglesAskedForAndLiesNear) {
  const auto ball = test::model_of(test::icosphere_mesh(1.0f, 4));
  double before = 0.0;
  for (const std::size_t triangles : {1000, 500, 100}) {
    const ReducedOccluder reduced = reduce_occluder(ball, triangles);
    EXPECT_LE(triangles_of(*reduced.model), triangles);
    EXPECT_GT(triangles_of(*reduced.model), triangles * 8 / 10);
    // Corners stay on the ball. The middle of one of n equal triangles sinks below it by half the
    // square of its circumradius, 16 pi / (6 sqrt(3) n); these are not equal.
    EXPECT_GT(reduced.error, before);
    EXPECT_LT(reduced.error, 4.0 * 4.84 / static_cast<double>(triangles));
    for (const glm::vec4& p : reduced.model->parts[0].mesh.positions)
      EXPECT_NEAR(glm::length(glm::vec3(p)), 1.0f, 1e-5f);
    before = reduced.error;
  }
}

TEST(ReducedOccluder, LeavesSmallModelsAndEmptyOnesAlone) {
  const auto box = test::model_of(test::box_mesh(glm::vec3(1.0f)));
  EXPECT_EQ(reduce_occluder(box, 100).model, box);
  const auto empty = std::make_shared<const Model>();
  EXPECT_EQ(reduce_occluder(empty, 100).model, empty);
}

TEST(ReducedOccluder, PartsAndOpenMeshesAreReducedToo) {
  Model model;
  model.parts.push_back({.mesh = test::icosphere_mesh(1.0f, 3)});
  model.parts.push_back({.mesh = test::icosphere_mesh(0.5f, 3)});
  model.parts[1].mesh.indices.resize(model.parts[1].mesh.indices.size() / 2 / 3 * 3);
  const auto reduced = reduce_occluder(std::make_shared<const Model>(model), 200);
  EXPECT_LE(triangles_of(*reduced.model), 200u);
  EXPECT_LT(reduced.error, 0.4);
}

TEST(ReducedOccluder, IsMadeOnceAndNotWhereAShadowModelIsGiven) {
  const auto ball = test::model_of(test::icosphere_mesh(1.0f, 4));
  const auto box = test::model_of(test::box_mesh(glm::vec3(1.0f)));
  const auto object = [&](const auto& shadow_model) {
    return Object{.name = "ball", .model = ball, .shadow_model = shadow_model};
  };
  Scene scene;
  scene.objects = {object(nullptr), object(box), object(nullptr)};
  scene.objects[2].casts = false;
  Scene again = scene, untouched = scene;
  ReducedOccluders reduced(300);
  reduced.apply(scene);
  reduced.apply(again);
  ASSERT_TRUE(scene.objects[0].shadow_model);
  EXPECT_EQ(scene.objects[0].shadow_model, again.objects[0].shadow_model);
  EXPECT_GT(scene.objects[0].shadow_displace, 0.0f);
  EXPECT_EQ(scene.objects[1].shadow_model, box);
  EXPECT_FALSE(scene.objects[2].shadow_model);
  ReducedOccluders(0).apply(untouched);
  EXPECT_FALSE(untouched.objects[0].shadow_model);
}

}  // namespace
}  // namespace gnomon::pipeline
