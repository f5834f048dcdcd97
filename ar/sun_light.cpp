#include "ar/sun_light.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ar/median.h"
#include "pipeline/source_set.h"
#include "pipeline/sun.h"

namespace gnomon::ar {
namespace {

/// A patch counts as in the sun if all of these rays reach it, and as in the shade if none does.
constexpr int kRays = 16;
/// Of a patch in the sun: where it grazes, a small error of the model is a large one of the light.
constexpr double kLeastCosine = 0.2;
/// A patch in the shade that gives more than this part of what it gets shines by itself.
constexpr double kBrightest = 1.0;

struct Shade {
  glm::dvec3 given{0.0}, received{0.0};
};

}  // namespace

std::optional<glm::dvec3> find_sun_irradiance(const pipeline::PatchModel& model,
                                              const pipeline::PatchExchange& exchange,
                                              const pipeline::PatchVisibility& visibility,
                                              const BalanceInput& input, int threads) {
  const pipeline::Patch& sun = model.patches[pipeline::sun_patch(model)];
  const Balanced first = balance_patches(model, exchange, input, threads);
  const std::vector<glm::dvec3> arriving = exchange.irradiance(first.radiance, threads);
  std::vector<double> cosines(model.patches.size(), 0.0);
  std::vector<Shade> shade(model.surfaces.size());
  std::vector<std::size_t> lit;
  for (std::size_t i = 0, near_count = model.near_count(); i < near_count; ++i) {
    const pipeline::Patch& patch = model.patches[i];
    if (!input.known[i]) continue;
    const double cosine = -glm::dot(patch.normal, sun.normal);
    const double share =
        cosine > 0.0 ? visibility.visible_share(sun, patch.center, patch.normal, kRays) : 0.0;
    // The sun's disc is small: whether all of the patch is lit is asked at its corners too.
    bool all = share == 1.0, none = share == 0.0;
    for (std::size_t k = 0; k < 3 && cosine > 0.0; ++k) {
      const glm::dvec3 near = glm::mix(model.corner(patch, k), patch.center, 0.05);
      const double at = visibility.visible_share(sun, near, patch.normal, 1);
      all = all && at == 1.0;
      none = none && at == 0.0;
    }
    if (all && cosine > kLeastCosine) {
      cosines[i] = cosine;
      lit.push_back(i);
    } else if (none && std::numbers::pi * pipeline::luminance(input.radiance[i]) <
                           kBrightest * pipeline::luminance(arriving[i])) {
      shade[patch.surface].given += std::numbers::pi * input.radiance[i] * patch.area_m2;
      shade[patch.surface].received += arriving[i] * patch.area_m2;
    }
  }
  std::array<std::vector<double>, 3> found;
  for (const std::size_t i : lit) {
    const Shade& rest = shade[model.patches[i].surface];
    for (int c = 0; c < 3; ++c) {
      if (!(rest.given[c] > 0.0)) continue;
      const double all = std::numbers::pi * input.radiance[i][c] * rest.received[c] / rest.given[c];
      found[static_cast<std::size_t>(c)].push_back((all - arriving[i][c]) / cosines[i]);
    }
  }
  glm::dvec3 irradiance(0.0);
  for (std::size_t c = 0; c < 3; ++c) {
    if (found[c].empty()) return std::nullopt;
    irradiance[static_cast<int>(c)] = std::max(0.0, median(std::move(found[c])));
  }
  return irradiance;
}

}  // namespace gnomon::ar
