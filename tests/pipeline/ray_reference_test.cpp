#include "pipeline/ray_reference.h"

#include <cmath>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

/// A plate with its top at y = 0, a virtual unit cube from y = 1 to 2 above it.
Scene cube_over_plate() {
  Scene scene;
  scene.objects = {{.name = "plate",
                    .role = Role::phantom,
                    .model = test::model_of(test::box_mesh({9, 1, 9})),
                    .world_from_model = test::placed({0, -1, 0})},
                   {.name = "cube",
                    .model = test::model_of(test::box_mesh(glm::vec3(0.5f))),
                    .world_from_model = test::placed({0, 1.5f, 0})}};
  return scene;
}

// Oracle: similar triangles. Light 4 m up: the cube's top (2 m) throws a square of half side 1.
TEST(RayReference, ShadowOfACubeEndsWhereSimilarTrianglesSay) {
  const RayReference rays(cube_over_plate());
  const glm::vec4 light(0, 4, 0, 1);
  for (const double x : {-1.01, -0.99, 0.0, 0.99, 1.01}) {
    const RayHit hit = rays.trace({{x, 0.5, 0.0}, {0.0, -1.0, 0.0}});
    ASSERT_TRUE(hit.hit);
    EXPECT_EQ(hit.object, 0u);
    EXPECT_NEAR(hit.distance, 0.5, 1e-6);
    EXPECT_EQ(rays.shadow(hit, light).in_shadow, std::abs(x) < 1.0);
    EXPECT_FALSE(rays.shadow(hit, light, Among::phantoms).in_shadow);
    EXPECT_EQ(rays.shadow(hit, {0, 1, 0, 0}).in_shadow, std::abs(x) < 0.5);
  }
}

TEST(RayReference, SeenSideDecidesWhetherASurfaceFacesTheLight) {
  const RayReference rays(cube_over_plate());
  const glm::vec4 light(0, 4, 0, 1);
  const RayHit top = rays.trace({{0.1, 3.0, 0.2}, {0.0, -1.0, 0.0}});
  EXPECT_EQ(top.object, 1u);
  EXPECT_NEAR(top.normal.y, 1.0, 1e-6);
  EXPECT_FALSE(rays.shadow(top, light).in_shadow);
  const RayHit bottom = rays.trace({{0.1, 0.5, 0.2}, {0.0, 1.0, 0.0}});
  EXPECT_NEAR(bottom.normal.y, -1.0, 1e-6);
  EXPECT_TRUE(rays.shadow(bottom, light).faces_away);
  EXPECT_TRUE(rays.shadow(bottom, light).in_shadow);
  EXPECT_FALSE(rays.shadow(bottom, light, Among::phantoms).in_shadow);
  const RayHit from_inside = rays.trace({{0.1, 1.5, 0.2}, {0.0, 1.0, 0.0}});
  EXPECT_NEAR(from_inside.normal.y, -1.0, 1e-6);
  EXPECT_TRUE(rays.shadow(from_inside, light).in_shadow);
}

TEST(RayReference, OnlyWhatIsVisibleIsHitAndOnlyWhatCastsBlocks) {
  Scene scene = cube_over_plate();
  scene.objects[1].casts = false;
  const RayReference rays(scene);
  const Ray down{{0.1, 3.0, 0.2}, {0.0, -1.0, 0.0}};
  EXPECT_EQ(rays.trace(down).object, 1u);
  EXPECT_EQ(rays.trace(down, Among::phantoms).object, 0u);
  EXPECT_FALSE(rays.trace({{0, 3, 0}, {0, 1, 0}}).hit);
  EXPECT_FALSE(rays.blocked({0.0, 0.5, 0.0}, {0, 4, 0, 1}));
  EXPECT_TRUE(rays.blocked({0.0, -0.5, 0.0}, {0, 4, 0, 1}));
}

// Oracle: the camera's matrix.
TEST(RayReference, PixelRaysGoThroughPixelCentres) {
  const Camera camera = test::look({1, 2, 3}, {0, 0, 0}, 8, 6);
  const std::vector<Ray> rays = pixel_rays(camera);
  ASSERT_EQ(rays.size(), 48u);
  const Ray& ray = rays[2 * 8 + 5];
  const glm::dvec4 clip =
      glm::dmat4(camera.clip_from_world) * glm::dvec4(ray.origin + 2.0 * ray.direction, 1.0);
  EXPECT_NEAR((clip.x / clip.w + 1.0) * 4.0, 5.5, 1e-5);
  EXPECT_NEAR((clip.y / clip.w + 1.0) * 3.0, 2.5, 1e-5);
}

}  // namespace
}  // namespace gnomon::pipeline
