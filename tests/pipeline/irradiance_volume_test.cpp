#include "pipeline/irradiance_volume.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/object_light.h"
#include "tests/pipeline/lit_room.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(SolidAngle, OfAnOctantIsAnEighthOfTheSphere) {
  EXPECT_NEAR(solid_angle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), kPi / 2, 1e-12);
  EXPECT_NEAR(solid_angle({5, 0, 0}, {0, 0, 0.1}, {0, 2, 0}), kPi / 2, 1e-12);
  // More than a hemisphere's worth would need a negative base.
  const double flat = solid_angle({1, 0, -1e-6}, {-0.5, 0.9, -1e-6}, {-0.5, -0.9, -1e-6});
  EXPECT_NEAR(flat, 2 * kPi, 1e-4);
}

// Oracle: their integrals over the sphere, by Fibonacci points.
TEST(Harmonics, AreOrthonormal) {
  constexpr int kCount = 20'000;
  double products[9][9] = {};
  for (int i = 0; i < kCount; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kCount, r = std::sqrt(1.0 - z * z);
    const double turn = 2.0 * kPi * 0.6180339887498949 * i;
    const auto y = harmonics({r * std::cos(turn), r * std::sin(turn), z});
    for (std::size_t a = 0; a < 9; ++a) {
      for (std::size_t b = 0; b < 9; ++b) products[a][b] += y[a] * y[b] * 4.0 * kPi / kCount;
    }
  }
  for (std::size_t a = 0; a < 9; ++a) {
    for (std::size_t b = 0; b < 9; ++b) EXPECT_NEAR(products[a][b], a == b ? 1.0 : 0.0, 1e-3);
  }
}

// Oracle: pi L on every side.
TEST(IrradianceVolume, OfEqualRadianceIsPiTimesIt) {
  LitScene scene = test::lit_room({.patches = 600, .table = false, .bounces = 0});
  std::fill(scene.radiance.begin(), scene.radiance.end(), glm::vec3(1.0f, 2.0f, 3.0f));
  const PatchVisibility visibility(scene.model);
  const IrradianceVolume volume(scene, visibility);
  std::mt19937 random(6);
  for (int i = 0; i < 40; ++i) {
    const glm::dvec3 point(test::uniform(random, -1.5f, 1.5f), test::uniform(random, 0.5f, 2.2f),
                           test::uniform(random, -1.5f, 1.5f));
    const glm::dvec3 normal(glm::normalize(test::uniform_point(random, -1.0f, 1.0f)));
    const glm::dvec3 light = volume.irradiance(point, normal);
    EXPECT_NEAR(light.x, kPi, 0.05 * kPi);
    EXPECT_NEAR(light.z, 3.0 * light.x, 1e-6);
  }
}

// Oracle: the sum over all patches with their form factors. A lamp's light has more than order 2,
// so the mean must be near and no single one far.
TEST(IrradianceVolume, IsNearTheSumOverPatches) {
  const LitScene scene = test::lit_room({.patches = 500});
  const PatchVisibility visibility(scene.model);
  const IrradianceVolume volume(scene, visibility, {.spacing_m = 0.3});
  std::mt19937 random(7);
  double error = 0.0, sum = 0.0;
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 point(test::uniform(random, -0.3f, 1.5f), test::uniform(random, 0.5f, 2.0f),
                           test::uniform(random, -0.3f, 1.5f));
    const glm::dvec3 normal(glm::normalize(test::uniform_point(random, -1.0f, 1.0f)));
    const double exact = irradiance(scene.model, scene.radiance, visibility, point, normal, 4).y;
    const double found = volume.irradiance(point, normal).y;
    error += std::abs(found - exact);
    sum += exact;
  }
  EXPECT_LT(error / sum, 0.12);
}

TEST(IrradianceVolume, IsTheSameForEveryNumberOfThreads) {
  const LitScene scene = test::lit_room();
  const PatchVisibility visibility(scene.model);
  const IrradianceVolume one(scene, visibility, {.spacing_m = 1.0, .threads = 1});
  const IrradianceVolume many(scene, visibility, {.spacing_m = 1.0, .threads = 5});
  const glm::dvec3 at(0.2, 1.1, 0.3), up(0, 1, 0);
  EXPECT_EQ(one.irradiance(at, up), many.irradiance(at, up));
}

TEST(DirectionMap, GoesFromDirectionToPlaceAndBack) {
  std::mt19937 random(8);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 way = glm::normalize(glm::dvec3(test::uniform_point(random, -1.0f, 1.0f)));
    double u = 0.0, v = 0.0;
    DirectionMap::place(way, u, v);
    EXPECT_NEAR(glm::length(DirectionMap::direction(u, v) - way), 0.0, 1e-9);
  }
  // OpenEXR's map: +z in the middle, +x a quarter to the left, +y at the top.
  EXPECT_NEAR(DirectionMap::direction(0.5, 0.5).z, 1.0, 1e-12);
  EXPECT_NEAR(DirectionMap::direction(0.25, 0.5).x, 1.0, 1e-12);
  EXPECT_NEAR(DirectionMap::direction(0.3, 0.0).y, 1.0, 1e-12);
}

TEST(Blur, KeepsAnEvenLightAndSpreadsASpot) {
  DirectionMap map{128, 64, std::vector<glm::vec3>(128 * 64, glm::vec3(2.0f)), {}};
  for (const glm::vec3& texel : blur(map, 20.0).radiance) EXPECT_NEAR(texel.x, 2.0f, 1e-5f);
  std::fill(map.radiance.begin(), map.radiance.end(), glm::vec3(0.0f));
  map.radiance[32 * 128 + 64] = glm::vec3(100.0f);
  const DirectionMap sharp = blur(map, 100.0), dull = blur(map, 5.0);
  const glm::dvec3 there = DirectionMap::direction(64.5 / 128, 32.5 / 64);
  const glm::dvec3 aside = glm::normalize(there + glm::dvec3(0.0, 0.7, 0.0));
  EXPECT_GT(sharp.at(there).x, dull.at(there).x);
  EXPECT_LT(sharp.at(aside).x, dull.at(aside).x);
}

}  // namespace
}  // namespace gnomon::pipeline
