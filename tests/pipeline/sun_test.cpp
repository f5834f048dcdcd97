// Sunlight as a distant patch. Oracles: what a parallel light gives, in closed form; the sources of
// the same room without a sun.
#include "pipeline/sun.h"

#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/irradiance_volume.h"
#include "pipeline/patch_light.h"
#include "pipeline/source_set.h"
#include "tests/pipeline/lit_room.h"

namespace gnomon::pipeline {
namespace {

const glm::dvec3 kDirection = glm::normalize(glm::dvec3(0.3, 1.0, 0.2));
constexpr test::RoomOptions kSunny{.patches = 400, .sun_irradiance = 20.0f};

TEST(Sun, GivesWhatAParallelLightGives) {
  const LitScene scene = test::lit_room(kSunny);
  const Patch& sun = scene.model.patches[sun_patch(scene.model)];
  const PatchVisibility visibility(scene.model);
  const glm::dvec3 up(0.0, 1.0, 0.0);
  for (const glm::dvec3& point : {glm::dvec3(1.0, 0.0, 1.0), glm::dvec3(-1.5, 0.0, 1.2)}) {
    const double factor = form_factor(point, up, scene.model.corners(sun));
    const double got =
        std::numbers::pi * factor * static_cast<double>(scene.radiance[sun_patch(scene.model)].x);
    // The patch is 200 diagonals away: a point a part of one nearer gets 1 % more, at most.
    EXPECT_NEAR(got / (20.0 * kDirection.y), 1.0, 0.01);
    EXPECT_EQ(visibility.visible_share(sun, point, up, 16), 1.0);
    EXPECT_LT(glm::length(glm::normalize(sun.center - point) - kDirection), 0.004);
  }
}

TEST(Sun, IsHiddenByWhatIsNotClear) {
  const LitScene scene = test::lit_room(kSunny);
  const Patch& sun = scene.model.patches[sun_patch(scene.model)];
  const PatchVisibility visibility(scene.model);
  // Where a ray through the table's middle (0.68 m up) meets the floor.
  const glm::dvec3 behind = glm::dvec3(-1.0, 0.68, -1.0) - kDirection * (0.68 / kDirection.y);
  EXPECT_EQ(visibility.visible_share(sun, behind, {0.0, 1.0, 0.0}, 16), 0.0);
  // Rays within the room still end at the ceiling, and none meets the sun.
  const auto hit = visibility.trace({1.0, 1.0, 1.0}, kDirection);
  ASSERT_NE(hit.patch, PatchVisibility::kNone);
  EXPECT_EQ(scene.model.surfaces[scene.model.patches[hit.patch].surface], "ceiling");
}

TEST(Sun, IsTheFirstSourceAndTakesNoneOfTheOthersPlace) {
  test::RoomOptions dark = kSunny;
  dark.sun_irradiance = 0.0f;
  LitScene scene = test::lit_room(kSunny);
  const LitScene without = test::lit_room(dark);
  const auto sources = find_sources(scene, 0.7);
  ASSERT_FALSE(sources.empty());
  EXPECT_EQ(sources.front(), sun_patch(scene.model));
  // The same lamps and walls, the sun beside them.
  for (std::size_t i = 0; i < without.radiance.size(); ++i) scene.radiance[i] = without.radiance[i];
  const auto with_sun = find_sources(scene, 0.7), others = find_sources(without, 0.7);
  EXPECT_EQ(std::vector(with_sun.begin() + 1, with_sun.end()), others);
}

TEST(Sun, LightsObjectsAndLeavesTheGridsBoxInTheRoom) {
  const LitScene scene = test::lit_room(kSunny);
  const PatchVisibility visibility(scene.model);
  const IrradianceVolume volume(scene, visibility);
  EXPECT_EQ(volume.points(), 10u * 8u * 10u);
  const glm::dvec3 up = volume.irradiance({1.0, 1.0, 1.0}, {0.0, 1.0, 0.0});
  // Order 2 of a parallel light: its cosine to 6 % (Ramamoorthi and Hanrahan 2001); the rest is the
  // panel's.
  EXPECT_GT(up.x, 0.9 * 20.0 * kDirection.y);
}

TEST(Sun, RefusesASecondSunAndASurfaceThatIsNone) {
  PatchModel model = make_patches(test::room_surfaces(), 50);
  EXPECT_THROW(add_sun(model, kDirection, {99}), std::invalid_argument);
  add_sun(model, kDirection, {});
  EXPECT_THROW(add_sun(model, kDirection, {}), std::invalid_argument);
  EXPECT_EQ(model.near_count() + 1, model.patches.size());
}

}  // namespace
}  // namespace gnomon::pipeline
