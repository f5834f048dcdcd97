#include "pipeline/light_samples.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

Light bulb(int samples) {
  return {.name = "bulb",
          .position = {1.0f, 4.0f, -2.0f, 1.0f},
          .color = {1.0f, 0.5f, 0.25f},
          .share = 0.6f,
          .radius = 0.3f,
          .samples = samples};
}

TEST(LightSamples, OneSampleIsTheCentre) {
  const std::vector<Light> one = sample_light(bulb(1), glm::vec3(0.0f));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].position, bulb(1).position);
  EXPECT_EQ(one[0].name, "bulb");
  EXPECT_EQ(one[0].share, 0.6f);
}

// Oracle: sums and the disc's geometry; the mean square radius of a uniform disc is r^2 / 2.
TEST(LightSamples, ShareTheLightOnADiscThatFacesTheScene) {
  for (const float w : {0.0f, 1.0f}) {
    Light light = bulb(64);
    light.position.w = w;
    if (w == 0.0f) light.position = glm::vec4(glm::normalize(glm::vec3(light.position)), 0.0f);
    const glm::vec3 facing(0.5f, 0.0f, 1.0f);
    const glm::vec3 axis =
        w == 0.0f ? glm::vec3(light.position) : glm::normalize(facing - glm::vec3(light.position));
    const std::vector<Light> samples = sample_light(light, facing);
    ASSERT_EQ(samples.size(), 64u);
    float share = 0.0f, mean_square = 0.0f;
    glm::vec3 color(0.0f), mean(0.0f);
    for (const Light& sample : samples) {
      share += sample.share;
      color += sample.color;
      glm::vec3 offset = glm::vec3(sample.position) - glm::vec3(light.position);
      // A direction was brought back to unit length: compare slopes across the axis.
      if (w == 0.0f) {
        const glm::vec3 p(sample.position);
        EXPECT_NEAR(glm::length(p), 1.0f, 1e-6f);
        offset = p / glm::dot(p, axis) - axis;
      }
      EXPECT_NEAR(glm::dot(offset, axis), 0.0f, 1e-5f);
      EXPECT_LE(glm::length(offset), 0.3f);
      mean_square += glm::dot(offset, offset) / 64.0f;
      mean += offset / 64.0f;
    }
    EXPECT_NEAR(share, 0.6f, 1e-5f);
    EXPECT_NEAR(glm::distance(color, light.color), 0.0f, 1e-5f);
    EXPECT_NEAR(mean_square, 0.045f, 1e-4f);
    EXPECT_LT(glm::length(mean), 0.02f);
  }
}

TEST(LightSamples, OfASceneKeepTheOrderOfItsLights) {
  Scene scene;
  scene.objects.push_back({.model = test::model_of(test::box_mesh(glm::vec3(1.0f)))});
  scene.lights = {bulb(3), bulb(1)};
  const std::vector<Light> lights = sample_lights(scene);
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(lights[0].name, "bulb 1/3");
  EXPECT_EQ(lights[3].name, "bulb");
}

TEST(LightSamples, WrongNumbersAreMisuse) {
  EXPECT_THROW(sample_light(bulb(0), {}), std::invalid_argument);
  EXPECT_THROW(sample_light(bulb(1025), {}), std::invalid_argument);
  Light dark = bulb(2);
  dark.share = 1.5f;
  EXPECT_THROW(sample_light(dark, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::pipeline
