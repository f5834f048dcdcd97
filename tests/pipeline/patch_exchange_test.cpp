// Oracles: energy in a closed room, and pipeline::irradiance, which sums one point at a time.
#include "pipeline/patch_exchange.h"

#include <numbers>

#include <gtest/gtest.h>

#include "patch_rooms.h"

namespace gnomon::pipeline {
namespace {

TEST(PatchExchange, EqualRadianceAllAroundGivesPiTimesItInAClosedRoom) {
  const PatchModel model = make_patches(cube_room(), 300);
  const PatchVisibility visibility(model);
  const PatchExchange exchange(model, visibility, 4, 1);
  const auto light =
      exchange.irradiance(std::vector<glm::vec3>(model.patches.size(), {1.0f, 2.0f, 0.0f}), 1);
  for (const glm::dvec3& e : light) {
    EXPECT_NEAR(e.x, std::numbers::pi, 1e-4);
    EXPECT_NEAR(e.y, 2.0 * std::numbers::pi, 2e-4);
    EXPECT_EQ(e.z, 0.0);
  }
}

TEST(PatchExchange, SumsWhatIrradianceSums) {
  Scene scene = cube_room();
  scene.objects.push_back(rectangle("screen", {-0.5f, -0.5f, 0.1f}, {1, 0, 0}, {0, 1, 0.2f}));
  const PatchModel model = make_patches(scene, 200);
  std::vector<glm::vec3> radiance;
  for (std::size_t i = 0; i < model.patches.size(); ++i)
    radiance.emplace_back(static_cast<float>(i % 7), static_cast<float>(i % 3), 0.5f);
  const PatchVisibility visibility(model);
  const auto light = PatchExchange(model, visibility, 4, 1).irradiance(radiance, 1);
  for (std::size_t i = 0; i < model.patches.size(); i += 5) {
    const Patch& p = model.patches[i];
    const glm::dvec3 expected = irradiance(model, radiance, visibility, p.center, p.normal, 4);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[i][c], expected[c], 1e-5);
  }
}

TEST(PatchExchange, IsTheSameForAnyNumberOfThreads) {
  const PatchModel model = make_patches(cube_room(), 150);
  const PatchVisibility visibility(model);
  const std::vector<glm::vec3> radiance(model.patches.size(), glm::vec3(0.3f, 0.2f, 0.7f));
  const auto one = PatchExchange(model, visibility, 1, 1).irradiance(radiance, 1);
  EXPECT_EQ(PatchExchange(model, visibility, 1, 3).irradiance(radiance, 3), one);
}

}  // namespace
}  // namespace gnomon::pipeline
