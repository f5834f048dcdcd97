#include "ar/model_file.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "ar/assimp_model.h"
#include "ar/file.h"
#include "ar/gltf.h"
#include "ar/mesh_bytes.h"

namespace gnomon::ar {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{512} << 20;

}  // namespace

ModelFile load_model(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path, kMaxFileBytes);
  const MeshFormat format = mesh_format(bytes, path);
  if (format == MeshFormat::gltf) {
    GltfModel file = read_gltf(path, bytes);
    return {std::move(file.model), std::move(file.notes)};
  }
  check_mesh_bytes(format, bytes, path);
  return read_with_assimp(format, bytes, path);
}

}  // namespace gnomon::ar
