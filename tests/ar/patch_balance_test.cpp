// Oracle: a room that a solver of the radiosity equation filled with light (here, by summing
// bounces), from which reflectances and hidden patches must be found again.
#include "ar/patch_balance.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "../pipeline/patch_rooms.h"

namespace gnomon::ar {
namespace {

/// A closed room with a lamp under its ceiling, all else of reflectance 0.6, 0.4, 0.2.
class LitRoom : public testing::Test {
 protected:
  LitRoom() {
    pipeline::Scene scene = cube_room();
    scene.objects.push_back(rectangle("lamp", {-0.25f, 0.9f, -0.25f}, {0.5f, 0, 0}, {0, 0, 0.5f}));
    model_ = pipeline::make_patches(scene, 400);
    visibility_.emplace(model_);
    exchange_.emplace(model_, *visibility_, 4, 0);
    radiance_.assign(model_.patches.size(), glm::vec3(0.0f));
    for (int bounce = 0; bounce < 60; ++bounce) {
      const auto light = exchange_->irradiance(radiance_, 0);
      for (std::size_t i = 0; i < radiance_.size(); ++i)
        radiance_[i] =
            is_lamp(i) ? glm::vec3(20.0f) : glm::vec3(kReflectance * light[i] / std::numbers::pi);
    }
  }
  bool is_lamp(std::size_t i) const { return model_.surfaces[model_.patches[i].surface] == "lamp"; }
  BalanceInput input() const {
    BalanceInput input;
    for (const glm::vec3& r : radiance_) input.radiance.emplace_back(r);
    input.known.assign(radiance_.size(), true);
    input.surface_reflectance.assign(model_.surfaces.size(), glm::vec3(0.5f, 0.3f, 0.1f));
    return input;
  }

  const glm::dvec3 kReflectance{0.6, 0.4, 0.2};
  pipeline::PatchModel model_;
  std::optional<pipeline::PatchVisibility> visibility_;
  std::optional<pipeline::PatchExchange> exchange_;
  std::vector<glm::vec3> radiance_;
};

TEST_F(LitRoom, GivesBackTheReflectanceItWasMadeWith) {
  const Balanced balanced = balance_patches(model_, *exchange_, input(), 0);
  for (std::size_t i = 0; i < radiance_.size(); ++i) {
    EXPECT_EQ(balanced.emits[i], is_lamp(i));
    const glm::dvec3 expected = is_lamp(i) ? glm::dvec3(0.5, 0.3, 0.1) : kReflectance;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(balanced.reflectance[i][c], expected[c], 1e-3);
  }
}

TEST_F(LitRoom, FillsHiddenPatchesWithWhatTheyReflect) {
  BalanceInput hidden = input();
  // Some of every surface but the lamp, and all of the floor, for which the model's guess stands.
  for (std::size_t i = 0; i < radiance_.size(); ++i) {
    const std::string& surface = model_.surfaces[model_.patches[i].surface];
    if (is_lamp(i) || (i % 4 != 0 && surface != "floor")) continue;
    hidden.known[i] = false;
    hidden.radiance[i] = glm::dvec3(1e6);
  }
  const auto floor = std::find(model_.surfaces.begin(), model_.surfaces.end(), "floor");
  hidden.surface_reflectance[static_cast<std::size_t>(floor - model_.surfaces.begin())] =
      glm::vec3(kReflectance);
  const Balanced balanced = balance_patches(model_, *exchange_, hidden, 0);
  for (std::size_t i = 0; i < radiance_.size(); ++i)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(balanced.radiance[i][c] / radiance_[i][c], 1.0, 0.02) << "patch " << i;
}

TEST_F(LitRoom, AHiddenPartOfALampShinesAsTheRest) {
  BalanceInput hidden = input();
  bool first = true;
  for (std::size_t i = 0; i < radiance_.size(); ++i)
    if (is_lamp(i)) {
      hidden.known[i] = first;
      first = false;
    }
  const Balanced balanced = balance_patches(model_, *exchange_, hidden, 0);
  for (std::size_t i = 0; i < radiance_.size(); ++i) {
    if (!is_lamp(i)) continue;
    EXPECT_NEAR(balanced.radiance[i].x, 20.0f, 1e-4f);
  }
}

TEST_F(LitRoom, WithoutLightReflectanceIsBounded) {
  BalanceInput dark = input();
  for (glm::dvec3& r : dark.radiance) r = glm::dvec3(0.0);
  const Balanced balanced = balance_patches(model_, *exchange_, dark, 0);
  for (const glm::vec3& r : balanced.reflectance)
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(r[c], 0.02f);
      EXPECT_LE(r[c], 0.95f);
    }
}

}  // namespace
}  // namespace gnomon::ar
