#include "ar/scene_models.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <utility>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/model_file.h"
#include "pipeline/surface_distance.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

namespace {

/// Of the distance of a model and its shadow model; docs/kuehl.md has what other factors leave.
constexpr double kDisplace = 2.0;

/// Reads each file once, by whatever names it is called.
class ModelReader {
 public:
  explicit ModelReader(std::vector<std::string>* notes) : notes_(notes) {}

  std::shared_ptr<const pipeline::Model> read(const fs::path& path) {
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    auto& model = read_[error ? path : canonical];
    if (!model) {
      ModelFile file = load_model(path);
      if (notes_ != nullptr)
        for (const std::string& note : file.notes)
          notes_->push_back(fmt::format("{}: {}", path.string(), note));
      model = std::make_shared<const pipeline::Model>(std::move(file.model));
    }
    return model;
  }

 private:
  std::vector<std::string>* notes_;
  std::map<fs::path, std::shared_ptr<const pipeline::Model>> read_;
};

bool can_cast(const pipeline::Model& model) {
  for (const pipeline::Part& part : model.parts) {
    const auto at = [&](std::size_t i) { return part.mesh.positions[part.mesh.indices[i]]; };
    for (std::size_t i = 0; i + 2 < part.mesh.indices.size(); i += 3)
      if (at(i) != at(i + 1) && at(i + 1) != at(i + 2) && at(i + 2) != at(i)) return true;
  }
  return false;
}

std::shared_ptr<const pipeline::Model> read_shadow_model(const SceneFile& scene,
                                                         const SceneObject& object,
                                                         ModelReader& reader) {
  const auto place = [&] {
    return fmt::format("{}:{}: [object '{}'].shadow_model", one_line(scene.file.string()),
                       object.shadow_model_line, one_line(object.name));
  };
  std::shared_ptr<const pipeline::Model> model;
  try {
    model = reader.read(object.shadow_model);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place(), error.what()));
  }
  if (!can_cast(*model))
    throw InputError(fmt::format("{}: {}: no triangle with three corners in different places",
                                 place(), one_line(object.shadow_model.string())));
  return model;
}

float displace_of(const SceneObject& object, const ObjectModels& models) {
  if (object.shadow_displace_m) return static_cast<float>(*object.shadow_displace_m);
  if (models.shadow_model == models.model) return 0.0f;
  return static_cast<float>(kDisplace *
                            pipeline::surface_distance(*models.model, *models.shadow_model));
}

}  // namespace

std::vector<ObjectModels> load_models(const SceneFile& scene, std::vector<std::string>* notes) {
  ModelReader reader(notes);
  std::vector<ObjectModels> models;
  for (const SceneObject& object : scene.objects) {
    ObjectModels of_object{.model = reader.read(object.model), .shadow_model = nullptr};
    if (!object.shadow_model.empty()) {
      of_object.shadow_model = read_shadow_model(scene, object, reader);
      of_object.shadow_displace = displace_of(object, of_object);
    }
    models.push_back(std::move(of_object));
  }
  return models;
}

}  // namespace gnomon::ar
