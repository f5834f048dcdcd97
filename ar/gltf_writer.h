// Models as glTF 2.0: one node, one mesh, a primitive a part. Materials go back the way that
// docs/models.md describes for reading. Internal to ar/.
#pragma once

#include <filesystem>

#include "pipeline/mesh.h"

namespace gnomon::ar {

/// Writes a .glb, or a .gltf with all of its data inside. Throws InputError if it cannot be
/// written.
void write_gltf(const std::filesystem::path& path, const pipeline::Model& model, bool binary);

}  // namespace gnomon::ar
