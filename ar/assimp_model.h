// Models of the formats that assimp reads, by one reader each: its own guess of the format, its
// other readers and other people's files stay out. Internal to ar/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "ar/mesh_bytes.h"
#include "ar/model_file.h"

namespace gnomon::ar {

/// Reads a mesh file's bytes. Polygons are cut into triangles; vertices are one where all that they
/// have is equal to the bit. An OBJ file's .mtl is read from the file's own folder.
/// Throws InputError as load_model says. Precondition: check_mesh_bytes has passed.
ModelFile read_with_assimp(MeshFormat format, std::span<const std::uint8_t> bytes,
                           const std::filesystem::path& path);

}  // namespace gnomon::ar
