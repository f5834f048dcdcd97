// Oracle: rooms whose sun is known.
#include "ar/sun_light.h"

#include <gtest/gtest.h>

#include "../pipeline/lit_room.h"
#include "pipeline/sun.h"

namespace gnomon::ar {
namespace {

struct Room {
  pipeline::LitScene scene;
  BalanceInput input;

  explicit Room(const test::RoomOptions& options) : scene(test::lit_room(options)) {
    for (const glm::vec3& radiance : scene.radiance) input.radiance.emplace_back(radiance);
    input.radiance.back() = glm::dvec3(0.0);
    input.known.assign(input.radiance.size(), true);
    input.surface_reflectance.assign(scene.model.surfaces.size(), glm::vec3(0.5f));
  }
  std::optional<glm::dvec3> find() const {
    const pipeline::PatchVisibility visibility(scene.model);
    const pipeline::PatchExchange exchange(scene.model, visibility, 4, 0);
    return find_sun_irradiance(scene.model, exchange, visibility, input, 0);
  }
};

TEST(SunLight, IsFoundFromWhatItLightsBesideWhatItDoesNot) {
  for (const float irradiance : {2.0f, 40.0f}) {
    // So many bounces that what is left out is a thousandth.
    const auto found = Room({.patches = 600, .bounces = 11, .sun_irradiance = irradiance}).find();
    ASSERT_TRUE(found);
    // The room is made with a ray a pair of patches, looked at with four.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR((*found)[c] / irradiance, 1.0, 0.05) << irradiance;
  }
}

TEST(SunLight, IsNotFoundWhereNothingIsInTheShade) {
  Room room({.patches = 300, .table = false, .sun_irradiance = 5.0f});
  for (std::size_t i = 0; i < room.input.known.size(); ++i)
    room.input.known[i] =
        room.scene.model.surfaces[room.scene.model.patches[i].surface] == "floor" ||
        room.scene.model.patches[i].distant;
  // The walls' shadows fall on parts of the floor; without those patches all of it is lit.
  const pipeline::PatchVisibility visibility(room.scene.model);
  const pipeline::Patch& sun = room.scene.model.patches[pipeline::sun_patch(room.scene.model)];
  for (std::size_t i = 0; i < room.scene.model.near_count(); ++i) {
    const pipeline::Patch& patch = room.scene.model.patches[i];
    if (visibility.visible_share(sun, patch.center, patch.normal, 1) == 0.0)
      room.input.known[i] = false;
  }
  EXPECT_FALSE(room.find());
}

}  // namespace
}  // namespace gnomon::ar
