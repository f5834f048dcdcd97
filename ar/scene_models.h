// The models that a scene file names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ar/scene_file.h"
#include "pipeline/mesh.h"

namespace gnomon::ar {

/// What an object is drawn with, and what casts in its place (null: the model itself), moved so far
/// away from lights (pipeline::Object::shadow_displace): as the file says, or twice the measured
/// distance of the two surfaces.
struct ObjectModels {
  std::shared_ptr<const pipeline::Model> model, shadow_model;
  float shadow_displace = 0.0f;
};

/// The models of each object, in the order of scene.objects; a file that is named several times is
/// read once and shared. Notes of the reader go to `notes` if given. Throws InputError, also where
/// none of a shadow model's triangles has three corners in different places.
std::vector<ObjectModels> load_models(const SceneFile& scene,
                                      std::vector<std::string>* notes = nullptr);

}  // namespace gnomon::ar
