#include "ar/fit_items.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ar/fit_settings.h"
#include "pipeline/bounds.h"
#include "pipeline/mesh_simplify.h"
#include "pipeline/reduced_occluder.h"

namespace gnomon::ar {

namespace {

/// Errors that phantoms are simplified with: the model's diagonal over powers of two.
constexpr int kCoarsestHalving = 2, kFinestHalving = 10;
/// Of triangles, from one occluder to the next with fewer; and the fewest.
constexpr double kOccluderStep = 0.6;
constexpr std::size_t kFewestTriangles = 4;
/// As ar/scene_models.cpp moves shadow models that say nothing of it.
constexpr double kDisplace = 2.0;

double diagonal_of(const pipeline::Model& model) {
  pipeline::Bounds bounds;
  for (const pipeline::Part& part : model.parts)
    for (const glm::vec4& p : part.mesh.positions) bounds.add(glm::dvec3(p));
  return bounds.empty() ? 0.0 : glm::length(bounds.high - bounds.low);
}

/// Keeps the given place in mind while options before it come and go.
class Ladder {
 public:
  explicit Ladder(FitItem item) : item_(std::move(item)) {}
  void add(FitOption option, bool is_given = false) {
    if (is_given) item_.given = item_.options.size();
    item_.options.push_back(std::move(option));
  }
  FitItem take() { return std::move(item_); }

 private:
  FitItem item_;
};

std::string triangles_text(std::size_t count) { return fmt::format("{} triangles", count); }

/// A phantom may be left out, or stand in coarser for the real thing.
FitItem phantom_item(const FitScene& given, std::size_t i) {
  const std::shared_ptr<const pipeline::Model> whole = given.objects[i].models.model;
  Ladder ladder({.name = fmt::format("phantom '{}'", given.file.objects[i].name),
                 .unit = "triangles",
                 .options = {},
                 .given = 0,
                 .object = i});
  ladder.add({"dropped", 0.0, [i](FitScene& scene) { scene.objects[i].kept = false; }});
  const auto with = [i](std::shared_ptr<const pipeline::Model> model) {
    return [i, model](FitScene& scene) {
      scene.objects[i].kept = true;
      scene.objects[i].models.model = model;
    };
  };
  const double diagonal = diagonal_of(*whole);
  std::size_t before = 0;
  for (int k = kCoarsestHalving; diagonal > 0.0 && k <= kFinestHalving; ++k) {
    pipeline::SimplifiedMesh simple =
        pipeline::simplify_mesh(*whole, diagonal / static_cast<double>(1 << k));
    const std::size_t count = triangle_count(simple.model);
    if (simple.report.given_up || count >= triangle_count(*whole)) continue;
    // A finer error that leaves no more triangles is the better one of the two.
    if (count <= before) continue;
    before = count;
    ladder.add({triangles_text(count), static_cast<double>(count),
                with(std::make_shared<const pipeline::Model>(std::move(simple.model)))});
  }
  ladder.add({"as given", static_cast<double>(triangle_count(*whole)), with(whole)}, true);
  return ladder.take();
}

/// A phantom's own shadow is in the photograph; it may be one that nothing virtual meets.
FitItem phantom_shadow_item(const FitScene& given, std::size_t i) {
  const FitObject& object = given.objects[i];
  const auto casting = static_cast<double>(triangle_count(
      object.models.shadow_model ? *object.models.shadow_model : *object.models.model));
  return {.name = fmt::format("shadow of phantom '{}'", given.file.objects[i].name),
          .unit = "triangles",
          .options = {{"casts nothing", 0.0, [i](FitScene& s) { s.objects[i].casts = false; }},
                      {"casts", casting, [i](FitScene& s) { s.objects[i].casts = true; }}},
          .given = 1,
          .object = i};
}

/// An object may cast with fewer triangles than it is drawn with, or not at all.
FitItem occluder_item(const FitScene& given, std::size_t i) {
  const ObjectModels of_given = given.objects[i].models;
  const std::shared_ptr<const pipeline::Model> whole = of_given.model;
  const std::size_t all = triangle_count(*whole);
  Ladder ladder({.name = fmt::format("shadow of '{}'", given.file.objects[i].name),
                 .unit = "triangles",
                 .options = {},
                 .given = 0,
                 .object = i});
  ladder.add({"casts nothing", 0.0, [i](FitScene& scene) { scene.objects[i].casts = false; }});
  const auto with = [i, whole](std::shared_ptr<const pipeline::Model> model, float displace) {
    return [i, whole, model, displace](FitScene& scene) {
      scene.objects[i].casts = true;
      scene.objects[i].models = {whole, model, displace};
    };
  };
  std::vector<std::pair<std::size_t, FitOption>> reduced;
  for (double wanted = static_cast<double>(all) * kOccluderStep; wanted >= kFewestTriangles;
       wanted *= kOccluderStep) {
    const pipeline::ReducedOccluder got =
        pipeline::reduce_occluder(whole, static_cast<std::size_t>(wanted));
    const std::size_t count = triangle_count(*got.model);
    if (got.model == whole || (!reduced.empty() && reduced.back().first == count)) continue;
    reduced.emplace_back(count,
                         FitOption{triangles_text(count), static_cast<double>(count),
                                   with(got.model, static_cast<float>(kDisplace * got.error))});
  }
  std::ranges::reverse(reduced);
  const bool has_own = of_given.shadow_model && of_given.shadow_model != whole;
  const std::size_t own = has_own ? triangle_count(*of_given.shadow_model) : all;
  const auto as_given = [&] {
    ladder.add({fmt::format("as given, {}", triangles_text(own)), static_cast<double>(own),
                [i, of_given](FitScene& scene) {
                  scene.objects[i].casts = true;
                  scene.objects[i].models = of_given;
                }},
               true);
  };
  bool added = !has_own;
  for (auto& [count, option] : reduced) {
    if (!added && count >= own) {
      as_given();
      added = true;
    }
    ladder.add(std::move(option));
  }
  if (!added) as_given();
  ladder.add({"casts itself", static_cast<double>(all), with(nullptr, 0.0f)}, !has_own);
  return ladder.take();
}

}  // namespace

std::vector<FitItem> fit_items(const FitScene& given, const FitSurvey& survey) {
  std::vector<FitItem> items;
  const bool differential = given.file.differential.has_value();
  for (std::size_t i = 0; i < given.objects.size(); ++i) {
    const SceneObject& object = given.file.objects[i];
    if (!survey.placed.contains(object.name)) continue;
    const bool phantom = object.role == pipeline::Role::phantom && survey.photographs;
    // Differential shadows know the lit scene in their place.
    if (phantom) items.push_back(phantom_item(given, i));
    if (!given.objects[i].casts || differential) continue;
    items.push_back(phantom ? phantom_shadow_item(given, i) : occluder_item(given, i));
  }
  std::vector<FitItem> settings = differential ? differential_items(given, survey.passes)
                                               : volume_items(given, survey.photographs);
  std::ranges::move(settings, std::back_inserter(items));
  if (survey.photographs) items.push_back(samples_item(given));
  std::erase_if(items, [](const FitItem& item) { return item.options.size() < 2; });
  return items;
}

}  // namespace gnomon::ar
