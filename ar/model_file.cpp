#include "ar/model_file.h"

#include "ar/gltf.h"

namespace gnomon::ar {

ModelFile load_model(const std::filesystem::path& path) {
  GltfModel file = read_gltf(path);
  return {std::move(file.model), std::move(file.notes)};
}

}  // namespace gnomon::ar
