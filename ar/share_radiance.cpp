#include "ar/share_radiance.h"

#include <glm/common.hpp>

#include "raster/check.h"

namespace gnomon::ar {
namespace {

/// Calls visit(pixel, patch, weight in steradians) for every share, in order.
template <class Visit>
void for_each_share(const PixelFootprints& pixels, const Visit& visit) {
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t k = pixels.first[i]; k < pixels.first[i + 1]; ++k) {
      const PatchShare& s = pixels.shares[k];
      visit(i, s.patch, pixels.solid_angle_sr[i] * static_cast<double>(s.share));
    }
  }
}

glm::dvec3 ratio(const glm::dvec3& measured, const glm::dvec3& explained) {
  glm::dvec3 result(0.0);
  for (int c = 0; c < 3; ++c) result[c] = explained[c] > 0.0 ? measured[c] / explained[c] : 0.0;
  return result;
}

}  // namespace

SharedRadiance share_radiance(const PixelFootprints& pixels, std::size_t patches, int rounds) {
  raster::require(rounds >= 0, "a number of rounds is not negative");
  SharedRadiance shared{std::vector<glm::dvec3>(patches, glm::dvec3(0.0)),
                        std::vector<double>(patches, 0.0), std::vector<double>(patches, 0.0)};
  for (const PatchShare& s : pixels.shares) shared.pixels[s.patch] += static_cast<double>(s.share);
  for_each_share(pixels, [&](std::size_t i, std::size_t patch, double weight) {
    shared.radiance[patch] += weight * pixels.radiance[i];
    shared.solid_angle_sr[patch] += weight;
  });
  const auto divide = [&](std::vector<glm::dvec3>& sums) {
    for (std::size_t p = 0; p < patches; ++p)
      if (shared.solid_angle_sr[p] > 0.0) sums[p] /= shared.solid_angle_sr[p];
  };
  divide(shared.radiance);
  std::vector<glm::dvec3> factors(patches);
  for (int round = 0; round < rounds; ++round) {
    factors.assign(patches, glm::dvec3(0.0));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      glm::dvec3 explained(0.0);
      for (std::size_t k = pixels.first[i]; k < pixels.first[i + 1]; ++k)
        explained +=
            static_cast<double>(pixels.shares[k].share) * shared.radiance[pixels.shares[k].patch];
      const glm::dvec3 missing = ratio(pixels.radiance[i], explained);
      for (std::size_t k = pixels.first[i]; k < pixels.first[i + 1]; ++k)
        factors[pixels.shares[k].patch] +=
            pixels.solid_angle_sr[i] * static_cast<double>(pixels.shares[k].share) * missing;
    }
    divide(factors);
    for (std::size_t p = 0; p < patches; ++p) shared.radiance[p] *= factors[p];
  }
  return shared;
}

}  // namespace gnomon::ar
