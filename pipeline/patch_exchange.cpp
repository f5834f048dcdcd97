#include "pipeline/patch_exchange.h"

#include <array>
#include <numbers>

#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

constexpr std::size_t kReceiversAChunk = 16;

}  // namespace

PatchExchange::PatchExchange(const PatchModel& model, const PatchVisibility& visibility,
                             int samples, int threads)
    : patches_(model.patches.size()) {
  raster::require(patches_ <= kMostPatches, "light between patches is found for 8192 at most");
  factors_.assign(patches_ * patches_, 0.0f);
  std::vector<std::array<glm::dvec3, 3>> triangles;
  for (const Patch& p : model.patches) triangles.push_back(model.corners(p));
  raster::for_each_chunk(
      patches_, kReceiversAChunk, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          const Patch& to = model.patches[i];
          for (std::size_t j = 0; j < patches_; ++j) {
            const double factor = form_factor(to.center, to.normal, triangles[j]);
            if (!(factor > 0.0)) continue;
            factors_[i * patches_ + j] = static_cast<float>(
                factor * visibility.visible_share(model.patches[j], to.center, to.normal, samples));
          }
        }
      });
}

std::vector<glm::dvec3> PatchExchange::irradiance(const std::vector<glm::vec3>& radiance,
                                                  int threads) const {
  raster::require(radiance.size() == patches_, "a radiance belongs to each patch");
  std::vector<glm::dvec3> result(patches_, glm::dvec3(0.0));
  raster::for_each_chunk(
      patches_, kReceiversAChunk, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          glm::dvec3 sum(0.0);
          for (std::size_t j = 0; j < patches_; ++j)
            sum += static_cast<double>(factors_[i * patches_ + j]) * glm::dvec3(radiance[j]);
          result[i] = std::numbers::pi * sum;
        }
      });
  return result;
}

}  // namespace gnomon::pipeline
