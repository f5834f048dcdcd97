// A scene in memory whose models and settings can be exchanged, so that what it needs of them can
// be found by measurement (docs/fit.md).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "ar/scene_file.h"
#include "ar/scene_models.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

struct FitObject {
  /// Not kept: left out of the scene.
  bool kept = true, casts = true;
  ObjectModels models;
};

/// Invariant: one object each of file.objects, in their order. Where the two disagree (casts,
/// models), the object here counts.
struct FitScene {
  SceneFile file;
  std::vector<FitObject> objects;
};

/// The scene as its file says it; a frame time for differential shadows, which a clock turns into
/// passes, becomes the passes of a scene that says nothing, and each light gets [[caster]] tables
/// of its own, which say the same. Reads the models. Throws InputError.
FitScene load_fit_scene(const SceneFile& file, std::vector<std::string>* notes = nullptr);

/// The scene with all on the exact side: every object casts with the model that is drawn; volumes
/// counted and as long as need be; of differential shadows every source, a pass for each, whole
/// occluders, volumes and floats (values; radiance only where the scene says it).
FitScene exact_scene(const FitScene& given);

std::size_t triangle_count(const pipeline::Model& model);

/// Of objects that are kept.
struct FitTotals {
  /// Of phantoms as they are drawn into the depth buffer, and of what casts.
  std::size_t phantom_triangles = 0, casting_triangles = 0;
};
FitTotals fit_totals(const FitScene& scene);

/// `placed` with the models, shadows and light samples of `scene`, object by object and light by
/// light of the same name.
pipeline::Scene with_fit(const pipeline::Scene& placed, const FitScene& scene);

}  // namespace gnomon::ar
