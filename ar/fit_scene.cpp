#include "ar/fit_scene.h"

#include <algorithm>
#include <utility>

namespace gnomon::ar {

namespace {

constexpr std::size_t kMostPasses = 100'000;

/// For each light the tables that speak of it, so that lights can be told apart.
std::vector<SceneCaster> casters_by_light(const SceneFile& file) {
  std::vector<SceneCaster> casters;
  for (const pipeline::Light& light : file.lights) {
    const std::size_t before = casters.size();
    for (SceneCaster caster : file.casters) {
      if (!caster.light.empty() && caster.light != light.name) continue;
      caster.light = light.name;
      casters.push_back(std::move(caster));
    }
    if (casters.size() == before) casters.push_back({.node = "", .light = light.name});
  }
  return casters;
}

const pipeline::Model& caster_of(const FitObject& object) {
  return object.models.shadow_model ? *object.models.shadow_model : *object.models.model;
}

/// What the object casts with where [differential].occluder_triangles bounds it.
std::size_t occluder_count(const FitScene& scene, const FitObject& object) {
  const std::size_t count = triangle_count(caster_of(object));
  if (!scene.file.differential || object.models.shadow_model) return count;
  const std::size_t most = scene.file.differential->settings.occluder_triangles;
  return most == 0 ? count : std::min(count, most);
}

}  // namespace

FitScene load_fit_scene(const SceneFile& file, std::vector<std::string>* notes) {
  FitScene scene{.file = file, .objects = {}};
  const std::vector<ObjectModels> models = load_models(file, notes);
  for (std::size_t i = 0; i < models.size(); ++i)
    scene.objects.push_back({.kept = true, .casts = file.objects[i].casts, .models = models[i]});
  scene.file.casters = casters_by_light(file);
  if (scene.file.differential) scene.file.differential->settings.budget_ms = 0.0;
  return scene;
}

FitScene exact_scene(const FitScene& given) {
  FitScene exact = given;
  for (FitObject& object : exact.objects) {
    object.models.shadow_model = nullptr;
    object.models.shadow_displace = 0.0f;
  }
  exact.file.shadow.method = ShadowMethod::automatic;
  exact.file.shadow.volume = AutomaticReach{};
  for (SceneCaster& caster : exact.file.casters) {
    if (caster.method == pipeline::ShadowMethod::none) continue;
    caster.method = pipeline::ShadowMethod::volumes;
    caster.map = {};
  }
  if (exact.file.differential) {
    DifferentialSettings& settings = exact.file.differential->settings;
    settings.method.take.passes = kMostPasses;
    // Radiance is another way to put shadows into values, not a finer one.
    if (settings.method.take.precision != pipeline::ShadowPrecision::radiance)
      settings.method.take.precision = pipeline::ShadowPrecision::values;
    settings.method.mask = pipeline::ShadowMask::volumes;
    settings.light.transfer.power_share = 1.0;
    settings.light.prune_share = 0.0;
    settings.occluder_triangles = 0;
  }
  return exact;
}

std::size_t triangle_count(const pipeline::Model& model) {
  std::size_t count = 0;
  for (const pipeline::Part& part : model.parts) count += part.mesh.triangle_count();
  return count;
}

FitTotals fit_totals(const FitScene& scene) {
  FitTotals totals;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const FitObject& object = scene.objects[i];
    if (!object.kept) continue;
    const bool phantom = scene.file.objects[i].role == pipeline::Role::phantom;
    if (phantom) totals.phantom_triangles += triangle_count(*object.models.model);
    if (object.casts && !(phantom && scene.file.differential))
      totals.casting_triangles += occluder_count(scene, object);
  }
  return totals;
}

pipeline::Scene with_fit(const pipeline::Scene& placed, const FitScene& scene) {
  pipeline::Scene out = placed;
  out.objects.clear();
  for (pipeline::Light& light : out.lights) {
    light.shadow_of_object.clear();
    const auto named = std::ranges::find(scene.file.lights, light.name, &pipeline::Light::name);
    if (named != scene.file.lights.end()) light.samples = named->samples;
  }
  for (std::size_t i = 0; i < placed.objects.size(); ++i) {
    const auto named =
        std::ranges::find(scene.file.objects, placed.objects[i].name, &SceneObject::name);
    if (named == scene.file.objects.end()) continue;
    const FitObject& fit =
        scene.objects[static_cast<std::size_t>(named - scene.file.objects.begin())];
    if (!fit.kept) continue;
    out.objects.push_back(placed.objects[i]);
    out.objects.back().model = fit.models.model;
    out.objects.back().casts = fit.casts;
    out.objects.back().shadow_model = fit.casts ? fit.models.shadow_model : nullptr;
    out.objects.back().shadow_displace = fit.casts ? fit.models.shadow_displace : 0.0f;
    for (std::size_t l = 0; l < out.lights.size(); ++l)
      if (!placed.lights[l].shadow_of_object.empty())
        out.lights[l].shadow_of_object.push_back(placed.lights[l].shadow_of_object[i]);
  }
  return out;
}

}  // namespace gnomon::ar
