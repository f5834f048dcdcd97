// Oracles: rays through a plane in closed form; solid angles of a sphere and of a picture.
#include "ar/pixel_footprints.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "../pipeline/patch_rooms.h"
#include "ar/capture_file.h"
#include "ar/probe_map.h"
#include "ar/share_radiance.h"

namespace gnomon::ar {
namespace {

FloatImage constant(int width, int height, float value) {
  return {width, height, std::vector<float>(static_cast<std::size_t>(width) * height * 3, value)};
}

/// A view along -z of the square [-1, 1]^2 at z = -1, a picture of 8 x 8 pixels.
std::optional<Ray> look(glm::dvec2 place) {
  const glm::dvec3 at((place.x + 0.5) / 4.0 - 1.0, 1.0 - (place.y + 0.5) / 4.0, -1.0);
  return Ray{glm::dvec3(0.0), glm::normalize(at)};
}

TEST(PixelFootprints, APixelIsSharedByItsNeighbourhoodOfATent) {
  // The left half of the view is one surface, the right half another.
  pipeline::Scene scene;
  scene.objects = {rectangle("left", {-9, -9, -1}, {9, 0, 0}, {0, 18, 0}),
                   rectangle("right", {0, -9, -1}, {9, 0, 0}, {0, 18, 0})};
  const pipeline::PatchModel model = pipeline::make_patches(scene, 4);
  const pipeline::PatchVisibility visibility(model);
  const FloatImage picture = constant(8, 8, 1.0f);
  const PixelFootprints pixels =
      find_footprints(picture, {0, 0, 8, 8}, look, visibility, model, {4, 1});
  // The outermost pixels have no neighbours on one side.
  ASSERT_EQ(pixels.size(), 36u);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    double left = 0.0, all = 0.0;
    for (std::size_t k = pixels.first[i]; k < pixels.first[i + 1]; ++k) {
      const auto share = static_cast<double>(pixels.shares[k].share);
      all += share;
      if (model.patches[pixels.shares[k].patch].surface == 0) left += share;
    }
    EXPECT_NEAR(all, 1.0, 1e-6);
    // Of the pixels beside the edge, half a pixel away, an eighth of the tent is over it, up to the
    // cells' solid angles.
    const std::size_t column = i % 6;
    const double expected = column < 2 ? 1.0 : column == 2 ? 0.875 : column == 3 ? 0.125 : 0.0;
    EXPECT_NEAR(left, expected, 0.01) << column;
  }
}

TEST(PixelFootprints, SolidAnglesOfAMirrorBallsRaysAreThoseOfItsPicture) {
  // From far away, the share sin^2 of a ball's disc mirrors the cone of twice the angle: of a
  // sphere's 4 pi steradians the part of the disc's area.
  const pipeline::PatchModel model = pipeline::make_patches(cube_room(), 50);
  const pipeline::PatchVisibility visibility(model);
  const MirrorBall ball{{0, 0, 0}, 1e-3, glm::dvec3(1.0)};
  const int side = 60;
  const auto ray = [&](glm::dvec2 place) -> std::optional<Ray> {
    const glm::dvec3 origin((place.x - (side - 1) / 2.0) / 25.0 * 1e-3,
                            (place.y - (side - 1) / 2.0) / 25.0 * 1e-3, 1.0);
    const auto hit = reflect(ball, {origin, {0, 0, -1}});
    if (!hit || hit->cos_incidence < 0.5) return std::nullopt;
    return hit->ray;
  };
  const FloatImage picture = constant(side, side, 1.0f);
  const PixelFootprints pixels =
      find_footprints(picture, {0, 0, side, side}, ray, visibility, model, {4, 2});
  // sin^2 of 60 degrees; cells at the border are left out whole.
  EXPECT_NEAR(pixels.total_sr, 4.0 * std::numbers::pi * 0.75, 0.15);
  EXPECT_EQ(pixels.open_sr, 0.0);
  EXPECT_EQ(pixels.back_sr, 0.0);
  for (const glm::dvec3& r : share_radiance(pixels, model.patches.size(), 3).radiance)
    EXPECT_TRUE(r.x == 0.0 || std::abs(r.x - 1.0) < 1e-6);
}

TEST(PixelFootprints, TellsOpenAndBackSidesApart) {
  pipeline::Scene scene;
  scene.objects = {rectangle("shown", {-1, -1, -1}, {1, 0, 0}, {0, 2, 0}),
                   // Seen from behind.
                   rectangle("turned", {0, -1, -1}, {0, 1, 0}, {1, 0, 0})};
  const pipeline::PatchModel model = pipeline::make_patches(scene, 4);
  const pipeline::PatchVisibility visibility(model);
  const PixelFootprints pixels =
      find_footprints(constant(8, 8, 1.0f), {0, 0, 8, 8}, look, visibility, model, {2, 1});
  EXPECT_NEAR(pixels.back_sr / pixels.total_sr, 0.25, 0.01);
  EXPECT_NEAR(pixels.open_sr / pixels.total_sr, 0.25, 0.01);
  for (const PatchShare& s : pixels.shares) EXPECT_EQ(model.patches[s.patch].surface, 0u);
}

TEST(PixelFootprints, ALatlongPictureCoversTheSphere) {
  const pipeline::PatchModel model = pipeline::make_patches(cube_room(), 50);
  const pipeline::PatchVisibility visibility(model);
  LatlongProbe probe;
  const LatlongPicture latlong(constant(32, 16, 3.0f), probe);
  const auto ray = [&](glm::dvec2 place) { return std::optional(latlong.ray(place)); };
  const PixelFootprints pixels =
      find_footprints(latlong.bordered(), {0, 0, 34, 18}, ray, visibility, model, {4, 1});
  EXPECT_EQ(pixels.size(), 32u * 16u);
  double sum = 0.0;
  for (const double w : pixels.solid_angle_sr) sum += w;
  // The tents' weights are those of the pixels, all of the sphere once.
  EXPECT_NEAR(sum, 4.0 * std::numbers::pi, 0.05);
}

TEST(LatlongPicture, LooksAheadInItsMiddleAndRightInItsRightHalf) {
  FloatImage picture = constant(64, 32, 0.0f);
  picture.at(31, 15)[0] = picture.at(32, 15)[0] = picture.at(31, 16)[0] = picture.at(32, 16)[0] =
      1.0f;
  picture.at(48, 16)[1] = picture.at(47, 16)[1] = picture.at(48, 15)[1] = picture.at(47, 15)[1] =
      1.0f;
  LatlongProbe probe;  // Towards -z, as a camera at rest looks: right is +x.
  const LatlongPicture latlong(picture, probe);
  EXPECT_NEAR(latlong.seen({0, 0, -1}).x, 1.0, 1e-6);
  EXPECT_NEAR(latlong.seen({1, 0, 0}).y, 1.0, 1e-6);
  EXPECT_NEAR(latlong.seen({-1, 0, 0}).y, 0.0, 1e-6);
  const Ray ray = latlong.ray({32.5, 16.5});
  EXPECT_NEAR(ray.direction.z, -1.0, 1e-12);
}

}  // namespace
}  // namespace gnomon::ar
