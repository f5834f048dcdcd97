#include "tests/pipeline/lit_room.h"

#include <array>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "pipeline/patch_light.h"
#include "pipeline/sun.h"
#include "tests/pipeline/patch_rooms.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::test {
namespace {

constexpr const char* kPanel = "panel";

}  // namespace

pipeline::Scene room_surfaces(const RoomOptions& options) {
  const glm::vec3 x(4.0f, 0.0f, 0.0f), y(0.0f, 3.0f, 0.0f), z(0.0f, 0.0f, 4.0f);
  const glm::vec3 low(-2.0f, 0.0f, -2.0f), high(2.0f, 3.0f, 2.0f);
  pipeline::Scene scene;
  scene.objects = {rectangle("floor", low, z, x), rectangle("ceiling", low + y, x, z),
                   rectangle("back", low, x, y),  rectangle("front", low + z, y, x),
                   rectangle("left", low, y, z),  rectangle("right", low + x, z, y)};
  const float half = options.panel_half_m;
  scene.objects.push_back(rectangle(kPanel, {0.4f - half, 2.9f, -0.2f - half},
                                    {2.0f * half, 0.0f, 0.0f}, {0.0f, 0.0f, 2.0f * half}));
  if (options.table) {
    scene.objects.push_back({.name = "table",
                             .role = pipeline::Role::phantom,
                             .model = model_of(box_mesh({0.4f, 0.02f, 0.4f})),
                             .world_from_model = placed({-1.0f, 0.68f, -1.0f})});
  }
  return scene;
}

pipeline::LitScene lit_room(const RoomOptions& options) {
  pipeline::LitScene scene;
  scene.model = pipeline::make_patches(room_surfaces(options), options.patches);
  scene.tone = pipeline::ToneCurve::from_gamma(2.2, 3.0);
  if (options.sun_irradiance > 0.0f) {
    std::vector<std::uint32_t> clear;
    for (std::uint32_t s = 0; s < scene.model.surfaces.size(); ++s)
      if (scene.model.surfaces[s] == "ceiling" || scene.model.surfaces[s] == kPanel)
        clear.push_back(s);
    pipeline::add_sun(scene.model, glm::normalize(glm::dvec3(0.3, 1.0, 0.2)), clear);
  }
  const std::size_t count = scene.model.patches.size();
  std::vector<glm::vec3> emitted(count, glm::vec3(0.0f));
  scene.reflectance.assign(count, glm::vec3(options.reflectance));
  for (std::size_t i = 0; i < count; ++i) {
    if (scene.model.surfaces[scene.model.patches[i].surface] != kPanel) continue;
    emitted[i] = glm::vec3(1.0f, 0.9f, 0.8f) * options.panel_radiance;
    scene.reflectance[i] = glm::vec3(0.0f);
  }
  if (options.sun_irradiance > 0.0f) {
    emitted.back() = glm::vec3(pipeline::sun_radiance(glm::dvec3(options.sun_irradiance)));
    scene.reflectance.back() = glm::vec3(0.0f);
  }
  scene.radiance = emitted;
  const pipeline::PatchVisibility visibility(scene.model);
  for (int bounce = 0; bounce < options.bounces; ++bounce) {
    std::vector<glm::vec3> next = emitted;
    for (std::size_t i = 0; i < count; ++i) {
      const pipeline::Patch& patch = scene.model.patches[i];
      next[i] += scene.reflectance[i] *
                 glm::vec3(pipeline::irradiance(scene.model, scene.radiance, visibility,
                                                patch.center, patch.normal, 1) /
                           std::numbers::pi);
    }
    scene.radiance = next;
  }
  return scene;
}

}  // namespace gnomon::test
