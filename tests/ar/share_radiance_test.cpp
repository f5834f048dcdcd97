// Oracles: the light that the pixels were made of; invariants of the multiplicative shares.
#include "ar/share_radiance.h"

#include <gtest/gtest.h>

namespace gnomon::ar {
namespace {

/// A pixel with its shares.
void add(PixelFootprints& pixels, double radiance, double solid_angle_sr,
         const std::vector<PatchShare>& shares) {
  pixels.shares.insert(pixels.shares.end(), shares.begin(), shares.end());
  pixels.first.push_back(pixels.shares.size());
  pixels.radiance.emplace_back(radiance, 2.0 * radiance, 0.0);
  pixels.solid_angle_sr.push_back(solid_angle_sr);
}

/// A lamp of radiance 1000 (patch 1) before a wall of radiance 2 (patch 0), straddled by four
/// pixels.
PixelFootprints lamp_between_pixels() {
  PixelFootprints pixels;
  for (int i = 0; i < 30; ++i) add(pixels, 2.0, 0.01, {{0, 1.0f}});
  for (const float lamp : {0.5f, 0.25f, 0.125f, 0.0625f}) {
    const double radiance =
        1000.0 * static_cast<double>(lamp) + 2.0 * (1.0 - static_cast<double>(lamp));
    add(pixels, radiance, 0.01, {{0, 1.0f - lamp}, {1, lamp}});
  }
  return pixels;
}

double explained(const PixelFootprints& pixels, const SharedRadiance& shared) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    for (std::size_t k = pixels.first[i]; k < pixels.first[i + 1]; ++k)
      sum += pixels.solid_angle_sr[i] * static_cast<double>(pixels.shares[k].share) *
             shared.radiance[pixels.shares[k].patch].x;
  return sum;
}

TEST(ShareRadiance, MeansLoseALampThatRoundsFind) {
  const PixelFootprints pixels = lamp_between_pixels();
  const SharedRadiance means = share_radiance(pixels, 3, 0);
  EXPECT_LT(means.radiance[1].x, 400.0);
  EXPECT_GT(means.radiance[0].x, 10.0);
  const SharedRadiance shared = share_radiance(pixels, 3, 200);
  EXPECT_NEAR(shared.radiance[1].x, 1000.0, 10.0);
  EXPECT_NEAR(shared.radiance[0].x, 2.0, 0.1);
}

TEST(ShareRadiance, EachRoundExplainsTheMeasuredLight) {
  const PixelFootprints pixels = lamp_between_pixels();
  double measured = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    measured += pixels.solid_angle_sr[i] * pixels.radiance[i].x;
  for (const int rounds : {0, 1, 2, 10})
    EXPECT_NEAR(explained(pixels, share_radiance(pixels, 3, rounds)), measured, 1e-6 * measured);
}

TEST(ShareRadiance, APatchThatNoPixelShowsGetsNothing) {
  const SharedRadiance shared = share_radiance(lamp_between_pixels(), 3, 5);
  EXPECT_EQ(shared.radiance[2], glm::dvec3(0.0));
  EXPECT_EQ(shared.pixels[2], 0.0);
  EXPECT_NEAR(shared.pixels[1], 0.9375, 1e-6);
}

TEST(ShareRadiance, AChannelWithoutLightStaysWithout) {
  const SharedRadiance shared = share_radiance(lamp_between_pixels(), 3, 5);
  EXPECT_EQ(shared.radiance[0].z, 0.0);
  EXPECT_NEAR(shared.radiance[1].y, 2.0 * shared.radiance[1].x, 1e-9);
}

}  // namespace
}  // namespace gnomon::ar
