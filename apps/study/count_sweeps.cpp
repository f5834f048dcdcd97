#include "apps/study/count_sweeps.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

const std::vector<double> kOverlaps = {1, 100, 127, 128, 254, 255, 256, 257, 511, 512, 1000, 1024};

void append(Mesh& mesh, const Mesh& more, const glm::vec3& at) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const glm::vec4& p : more.positions) mesh.positions.push_back(p + glm::vec4(at, 0.0f));
  for (const std::uint32_t i : more.indices) mesh.indices.push_back(first + i);
}

/// Boxes or sheets one over the other towards the light, at heights from 1 to 2 m, so that all
/// shadow the same patch about the origin. A bit of `input` each: a lamp or a light at infinity;
/// boxes or sheets.
View stack(std::size_t count, bool one_mesh, std::size_t input) {
  const bool lamp = input % 2 == 0, sheets = input / 2 % 2 == 1;
  constexpr glm::vec3 kLight(2.4f, 6.0f, 1.2f);
  Scene scene =
      ground_under(lamp ? glm::vec4(kLight, 1.0f) : glm::vec4(glm::normalize(kLight), 0.0f));
  Mesh all;
  for (std::size_t i = 0; i < count; ++i) {
    const float height = 1.0f + (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    const glm::vec3 at = kLight * (height / kLight.y);
    const float half = lamp ? 0.6f * (1.0f - height / kLight.y) : 0.6f;
    const float thick = 0.25f / static_cast<float>(count);
    Mesh mesh = sheets ? square_mesh(half) : box_mesh({half, thick, half});
    mesh.normals.clear();
    if (one_mesh)
      append(all, mesh, at);
    else
      add_object(scene, "part", model_of(std::move(mesh)), placed(at));
  }
  if (one_mesh) add_object(scene, "stack", model_of(std::move(all)), glm::mat4(1.0f));
  add_object(scene, "ball", model_of(icosphere_mesh(0.25f, 3)), placed({0.1f, 0.25f, 0.0f}));
  // Its own shadow would be one more.
  scene.objects.back().casts = false;
  add_object(scene, "torus", model_of(torus_mesh(0.3f, 0.1f, 24, 12)), placed({-1.1f, 0.3f, 0.1f}));
  return {"", std::move(scene),
          look({-1.6f, 1.3f, 2.2f}, {0.0f, 0.2f, 0.0f}, kSweepWidth, kSweepHeight)};
}

std::vector<ShadowSetting> counting_settings() {
  std::vector<ShadowSetting> out = swept_settings();
  out.emplace_back(volumes("z-pass, single-sided", VolumeMethod::zpass)).single_sided = true;
  out.emplace_back(volumes("z-fail, single-sided", VolumeMethod::zfail)).single_sided = true;
  out.emplace_back(volumes("z-fail, saturating", VolumeMethod::zfail)).appendix_letter = true;
  return out;
}

TrialSweep::Plan overlapping(bool one_mesh) {
  TrialSweep::Plan plan;
  plan.text = {
      one_mesh ? "overlaps-in-mesh" : "overlaps",
      one_mesh ? "One mesh casts many shadows over each other" : "Many shadows lie over each other",
      std::string(one_mesh ? "A mesh of so many" : "So many") +
          " boxes, and sheets without thickness, in turns, stand in each other's light, "
          "a lamp's and one at infinity, and shadow one patch of the ground and a ball. " +
          std::string(
              one_mesh
                  ? "Its volume is counted at once, and counts that wrap come back to 0 at "
                    "each multiple of 256."
                  : "Volumes are counted in batches that become a flag, so that no count comes "
                    "back to 0."),
      one_mesh ? "parts of the mesh" : "casters",
      kWrongPixels,
      kRays};
  plan.values = number_texts(kOverlaps);
  plan.inputs = 4;
  plan.settings = counting_settings();
  plan.view = [one_mesh](std::size_t value, std::size_t input) {
    return stack(static_cast<std::size_t>(kOverlaps[value]), one_mesh, input);
  };
  return plan;
}

}  // namespace

void add_count_sweeps(Sweeps& sweeps, int threads) {
  for (const bool one_mesh : {false, true})
    sweeps.push_back(std::make_unique<TrialSweep>(overlapping(one_mesh), threads));
}

}  // namespace gnomon::apps::study
