#include "pipeline/near_clip.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/ray_reference.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

// Oracle: the camera's own matrix: eye and corners go back to where they came from.
TEST(NearRegion, IsTheEyeAndTheNearRectangle) {
  const Camera camera = test::look({1, 2, 3}, {0, 0.5f, -1}, 640, 480);
  const auto region = near_region(camera.clip_from_world);
  ASSERT_TRUE(region);
  ASSERT_EQ(region->corners.size(), 5u);
  EXPECT_NEAR(glm::distance(region->corners[0], glm::dvec3(1, 2, 3)), 0.0, 1e-5);
  for (std::size_t i = 1; i < 5; ++i) {
    const glm::dvec4 clip =
        glm::dmat4(camera.clip_from_world) * glm::dvec4(region->corners[i], 1.0);
    EXPECT_NEAR(std::abs(clip.x / clip.w), 1.0, 1e-6);
    EXPECT_NEAR(std::abs(clip.y / clip.w), 1.0, 1e-6);
    EXPECT_NEAR(clip.z / clip.w, -1.0, 1e-6);
  }
}

TEST(NearRegion, IsAbsentForAMatrixWithoutInverseOrEye) {
  EXPECT_FALSE(near_region(glm::mat4(0.0f)));
  EXPECT_FALSE(near_region(glm::mat4(1.0f)));
}

// Oracle: a wall between lamp and camera shades it; one beside does not.
TEST(VolumeMethod, IsZFailInTheShadowAndZPassBesideIt) {
  const Topology sphere = build_topology(*test::model_of(test::icosphere_mesh(0.5f, 1)));
  const Camera camera = test::look({0, 0, 5}, {0, 0, 0}, 64, 48);
  const auto region = near_region(camera.clip_from_world);
  for (const float w : {0.0f, 1.0f}) {
    const glm::vec4 light(0.0f, 0.0f, -9.0f, w);
    EXPECT_EQ(
        choose_method(VolumeMethod::automatic, region, light, sphere, test::placed({0, 0, 1})),
        VolumeMethod::zfail);
    EXPECT_EQ(
        choose_method(VolumeMethod::automatic, region, light, sphere, test::placed({3, 0, 1})),
        VolumeMethod::zpass);
    EXPECT_EQ(
        choose_method(VolumeMethod::automatic, region, light, sphere, test::placed({0, 0, 9})),
        VolumeMethod::zpass);
    EXPECT_EQ(choose_method(VolumeMethod::zpass, region, light, sphere, test::placed({0, 0, 1})),
              VolumeMethod::zpass);
    EXPECT_EQ(choose_method(VolumeMethod::automatic, {}, light, sphere, test::placed({3, 0, 1})),
              VolumeMethod::zfail);
  }
}

// Oracle: rays from points of the near region to the light. Where one is blocked, the answer must
// be "may touch".
TEST(VolumeMayTouch, NeverMissesAShadedNearPlane) {
  std::mt19937 random(3);
  std::size_t shaded = 0, safe = 0;
  for (int round = 0; round < 400; ++round) {
    const Scene scene = test::random_scene(random);
    const glm::vec3 eye = test::uniform_point(random, -3.0f, 3.0f);
    const Camera camera =
        test::look(eye, test::uniform_point(random, -1.0f, 1.0f), 64, 48, 60.0f, 0.2f);
    const auto region = near_region(camera.clip_from_world);
    ASSERT_TRUE(region);
    const glm::vec4 light = scene.lights[0].position;
    for (const Object& object : scene.objects) {
      Scene one;
      one.objects = {object};
      const RayReference rays(one);
      bool blocked = false;
      for (int sample = 0; sample < 60 && !blocked; ++sample) {
        glm::dvec3 point(0.0);
        double sum = 0.0;
        for (const glm::dvec3& corner : region->corners) {
          const double weight = test::uniform(random, 0.0f, 1.0f);
          point += weight * corner;
          sum += weight;
        }
        blocked = rays.blocked(point / sum, light);
      }
      const bool may =
          volume_may_touch(*region, light, build_topology(*object.model), object.world_from_model);
      EXPECT_TRUE(may || !blocked);
      shaded += blocked;
      safe += !may;
    }
  }
  EXPECT_GT(shaded, 50u);
  EXPECT_GT(safe, 800u);
  std::printf("near regions shaded: %zu, proved safe: %zu\n", shaded, safe);
}

}  // namespace
}  // namespace gnomon::pipeline
