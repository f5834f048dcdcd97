#include "ar/patch_balance.h"

#include <algorithm>
#include <numbers>

#include <glm/common.hpp>

#include "raster/check.h"

namespace gnomon::ar {
namespace {

constexpr double kDarkest = 0.02, kLightest = 0.95;
/// Each passes unknown patches' light on once more, which loses a reflectance's part of it.
constexpr int kBounces = 6;

double total(const glm::dvec3& v) { return v.x + v.y + v.z; }

/// Means over a surface's known patches, by area.
struct SurfaceMeans {
  glm::dvec3 radiance{0.0}, reflectance{0.0};
  double emitting_m2 = 0.0, reflecting_m2 = 0.0;

  bool emits() const { return emitting_m2 > reflecting_m2; }
};

class Balance {
 public:
  Balance(const pipeline::PatchModel& model, const BalanceInput& input)
      : model_(model), input_(input), emits_(model.patches.size(), false) {
    for (std::size_t i = 0; i < model.patches.size(); ++i)
      radiance_.emplace_back(input.known[i] ? input.radiance[i] : glm::dvec3(0.0));
  }

  const std::vector<glm::vec3>& radiance() const { return radiance_; }

  /// Judges the known patches by the light that reaches them, and lets the unknown ones reflect it.
  void update(const std::vector<glm::dvec3>& irradiance) {
    std::vector<SurfaceMeans> means(model_.surfaces.size());
    for (std::size_t i = 0; i < model_.patches.size(); ++i) {
      if (!input_.known[i]) continue;
      const double area_m2 = model_.patches[i].area_m2;
      SurfaceMeans& mean = means[model_.patches[i].surface];
      emits_[i] = std::numbers::pi * total(input_.radiance[i]) > total(irradiance[i]);
      if (emits_[i]) {
        mean.radiance += area_m2 * input_.radiance[i];
        mean.emitting_m2 += area_m2;
      } else {
        mean.reflectance += area_m2 * measured(i, irradiance[i]);
        mean.reflecting_m2 += area_m2;
      }
    }
    for (std::size_t i = 0; i < model_.patches.size(); ++i) {
      if (input_.known[i]) continue;
      const SurfaceMeans& mean = means[model_.patches[i].surface];
      emits_[i] = mean.emits();
      const glm::dvec3 light = mean.emits() ? mean.radiance / mean.emitting_m2
                                            : reflectance_of(mean, model_.patches[i].surface) *
                                                  irradiance[i] / std::numbers::pi;
      radiance_[i] = glm::vec3(light);
    }
    means_ = std::move(means);
  }

  Balanced result(const std::vector<glm::dvec3>& irradiance) && {
    Balanced balanced{std::move(radiance_), {}, std::move(emits_)};
    for (std::size_t i = 0; i < model_.patches.size(); ++i) {
      const std::uint32_t surface = model_.patches[i].surface;
      glm::dvec3 reflectance(input_.surface_reflectance[surface]);
      if (!balanced.emits[i])
        reflectance =
            input_.known[i] ? measured(i, irradiance[i]) : reflectance_of(means_[surface], surface);
      balanced.reflectance.emplace_back(glm::clamp(reflectance, kDarkest, kLightest));
    }
    return balanced;
  }

 private:
  glm::dvec3 measured(std::size_t patch, const glm::dvec3& irradiance) const {
    glm::dvec3 result(kLightest);
    for (int c = 0; c < 3; ++c)
      if (irradiance[c] > 0.0)
        result[c] = std::numbers::pi * input_.radiance[patch][c] / irradiance[c];
    return glm::clamp(result, kDarkest, kLightest);
  }
  glm::dvec3 reflectance_of(const SurfaceMeans& mean, std::uint32_t surface) const {
    return mean.reflecting_m2 > 0.0 ? mean.reflectance / mean.reflecting_m2
                                    : glm::dvec3(input_.surface_reflectance[surface]);
  }

  const pipeline::PatchModel& model_;
  const BalanceInput& input_;
  std::vector<glm::vec3> radiance_;
  std::vector<bool> emits_;
  std::vector<SurfaceMeans> means_;
};

}  // namespace

Balanced balance_patches(const pipeline::PatchModel& model, const pipeline::PatchExchange& exchange,
                         const BalanceInput& input, int threads) {
  raster::require(
      input.radiance.size() == model.patches.size() && input.known.size() == model.patches.size(),
      "each patch is known or not");
  raster::require(input.surface_reflectance.size() == model.surfaces.size(),
                  "each surface has a guess of its reflectance");
  Balance balance(model, input);
  for (int bounce = 0; bounce < kBounces; ++bounce)
    balance.update(exchange.irradiance(balance.radiance(), threads));
  const std::vector<glm::dvec3> irradiance = exchange.irradiance(balance.radiance(), threads);
  return std::move(balance).result(irradiance);
}

}  // namespace gnomon::ar
