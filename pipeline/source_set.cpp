#include "pipeline/source_set.h"

#include <algorithm>

#include "pipeline/patch_light.h"
#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::pipeline {

std::vector<std::uint32_t> find_sources(const LitScene& scene, double power_share) {
  raster::require(power_share >= 0.0 && power_share <= 1.0, "a share of the power is in [0, 1]");
  const std::vector<Patch>& patches = scene.model.patches;
  raster::require(scene.radiance.size() == patches.size(), "a radiance belongs to each patch");
  std::vector<double> light(patches.size());
  double power = 0.0;
  std::vector<std::uint32_t> sources;
  for (std::uint32_t i = 0; i < patches.size(); ++i) {
    light[i] = luminance(scene.radiance[i]);
    if (!patches[i].distant) power += light[i] * patches[i].area_m2;
    if (light[i] > 0.0) sources.push_back(i);
  }
  std::stable_sort(sources.begin(), sources.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return light[a] > light[b]; });
  // Nothing in the scene comes near a sun's radiance; should it, the sun goes first all the same.
  const auto first_near = std::stable_partition(
      sources.begin(), sources.end(), [&](std::uint32_t i) { return patches[i].distant; });
  double sum = 0.0;
  auto count = static_cast<std::size_t>(first_near - sources.begin());
  const std::size_t distant = count;
  while (count < sources.size() && (count == distant || sum < power_share * power)) {
    sum += light[sources[count]] * patches[sources[count]].area_m2;
    ++count;
  }
  sources.resize(count);
  return sources;
}

Transfers compute_transfers(const LitScene& scene, const TransferOptions& options) {
  const PatchModel& model = scene.model;
  Transfers transfers{find_sources(scene, options.power_share), model.vertices.size(), {}};
  transfers.radiance.assign(transfers.sources.size() * transfers.vertices, glm::vec3(0.0f));
  const std::vector<glm::vec3> reflectance = at_vertices(model, scene.reflectance);
  const PatchVisibility visibility(model);
  constexpr std::size_t kChunk = 16;
  raster::for_each_chunk(
      transfers.vertices, kChunk, options.threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t v = first; v < last; ++v) {
          const glm::dvec3 point(model.vertices[v].position), normal(model.vertices[v].normal);
          for (std::size_t s = 0; s < transfers.sources.size(); ++s) {
            const std::uint32_t source = transfers.sources[s];
            const Patch& patch = model.patches[source];
            const double factor = form_factor(point, normal, model.corners(patch));
            if (factor <= 0.0) continue;
            const double seen = visibility.visible_share(patch, point, normal, options.samples);
            transfers.radiance[s * transfers.vertices + v] = glm::vec3(
                glm::dvec3(reflectance[v]) * glm::dvec3(scene.radiance[source]) * (factor * seen));
          }
        }
      });
  return transfers;
}

}  // namespace gnomon::pipeline
