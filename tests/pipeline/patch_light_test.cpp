#include "pipeline/patch_light.h"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/pipeline/lit_room.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

/// Of a rectangle a x b parallel to the element, one corner straight above it at distance 1.
double parallel_rectangle(double a, double b) {
  const double x = std::sqrt(1.0 + a * a), y = std::sqrt(1.0 + b * b);
  return (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2.0 * std::numbers::pi);
}

// Oracle: the closed form (Howell's catalogue of configuration factors, B-3).
TEST(FormFactor, OfAParallelRectangleIsTheClosedForm) {
  for (const auto& [a, b] : {std::pair(1.0, 1.0), {0.3, 2.0}, {5.0, 0.1}, {20.0, 30.0}}) {
    const glm::dvec3 p(0, 1, 0), q(a, 1, 0), r(a, 1, b), s(0, 1, b);
    const glm::dvec3 up(0, 1, 0), here(0.0);
    // Seen from below, counter-clockwise.
    const double sum = form_factor(here, up, {p, q, r}) + form_factor(here, up, {p, r, s});
    EXPECT_NEAR(sum, parallel_rectangle(a, b), 1e-12) << a << " " << b;
  }
}

TEST(FormFactor, IsNoneBehindTheTriangleAndBelowTheHorizon) {
  const glm::dvec3 up(0, 1, 0), here(0.0);
  EXPECT_EQ(form_factor(here, up, {glm::dvec3(0, 1, 0), {0, 1, 1}, {1, 1, 0}}), 0.0);
  EXPECT_EQ(form_factor(here, -up, {glm::dvec3(0, 1, 0), {1, 1, 0}, {0, 1, 1}}), 0.0);
}

// Oracle: a hemisphere of equal radiance is seen whole, whatever it is cut into.
TEST(FormFactor, SumsToOneInAClosedRoom) {
  const PatchModel model = make_patches(test::room_surfaces({.table = false}), 400);
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 point(test::uniform(random, -1.9f, 1.9f), test::uniform(random, 0.1f, 2.8f),
                           test::uniform(random, -1.9f, 1.9f));
    const glm::dvec3 normal(glm::normalize(test::uniform_point(random, -1.0f, 1.0f)));
    double sum = 0.0;
    for (const Patch& patch : model.patches) {
      // The panel hides a part of the ceiling: leave it out.
      if (model.surfaces[patch.surface] == "panel") continue;
      sum += form_factor(point, normal,
                         {model.corner(patch, 0), model.corner(patch, 1), model.corner(patch, 2)});
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
  }
}

TEST(PatchVisibility, SeesThePanelFromTheFloorButNotThroughTheTable) {
  const PatchModel model = make_patches(test::room_surfaces(), 300);
  const PatchVisibility visibility(model);
  const glm::dvec3 up(0, 1, 0);
  for (const Patch& patch : model.patches) {
    if (model.surfaces[patch.surface] != "panel") continue;
    EXPECT_EQ(visibility.visible_share(patch, {0.4, 0.0, -0.2}, up, 16), 1.0);
    // From there the panel lies behind the table's top, whole.
    const glm::dvec3 way = glm::dvec3(0.4, 2.9, -0.2) - glm::dvec3(-1.0, 0.68, -1.0);
    const glm::dvec3 floor = glm::dvec3(-1.0, 0.68, -1.0) - way * (0.68 / way.y);
    EXPECT_EQ(visibility.visible_share(patch, floor, up, 16), 0.0);
  }
}

TEST(PatchVisibility, TracesTheNearestPatchAndItsSide) {
  const PatchModel model = make_patches(test::room_surfaces(), 300);
  const PatchVisibility visibility(model);
  const auto down = visibility.trace({-1.0, 2.0, -1.0}, {0.0, -1.0, 0.0});
  ASSERT_NE(down.patch, PatchVisibility::kNone);
  EXPECT_EQ(model.surfaces[model.patches[down.patch].surface], "table");
  EXPECT_NEAR(down.distance, 1.3, 1e-5);
  EXPECT_TRUE(down.front);
  EXPECT_NEAR(down.weights.x + down.weights.y + down.weights.z, 1.0, 1e-12);
  const auto from_outside = visibility.trace({0.0, -1.0, 1.0}, {0.0, 1.0, 0.0});
  EXPECT_FALSE(from_outside.front);
  EXPECT_EQ(visibility.trace({0.0, -1.0, 0.0}, {0.0, -1.0, 0.0}).patch, PatchVisibility::kNone);
}

TEST(PatchVisibility, RefusesAnotherNumberOfSamples) {
  EXPECT_THROW(patch_samples(5), std::invalid_argument);
  for (const int samples : {1, 4, 16}) {
    glm::dvec3 mean(0.0);
    for (const glm::dvec3& weights : patch_samples(samples)) {
      mean += weights / static_cast<double>(samples);
      EXPECT_GT(std::min({weights.x, weights.y, weights.z}), 0.0);
    }
    EXPECT_EQ(patch_samples(samples).size(), static_cast<std::size_t>(samples));
    EXPECT_NEAR(mean.x, 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(mean.y, 1.0 / 3.0, 1e-12);
  }
}

// Oracle: everything of radiance L around gives pi L.
TEST(Irradiance, OfEqualRadianceAllAroundIsPiTimesIt) {
  const PatchModel model = make_patches(test::room_surfaces({.table = false}), 400);
  const PatchVisibility visibility(model);
  const std::vector<glm::vec3> radiance(model.patches.size(), glm::vec3(2.0f, 1.0f, 0.5f));
  const glm::dvec3 light =
      irradiance(model, radiance, visibility, {0.3, 0.0, 0.4}, {0.0, 1.0, 0.0}, 16);
  // Single samples decide about patches that the panel's rim hides in part.
  EXPECT_NEAR(light.x, 2.0 * std::numbers::pi, 0.02);
  EXPECT_NEAR(light.y, light.x / 2.0, 1e-9);
}

}  // namespace
}  // namespace gnomon::pipeline
