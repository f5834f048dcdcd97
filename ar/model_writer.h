// Models into files.
#pragma once

#include <filesystem>
#include <string_view>

#include "pipeline/mesh.h"

namespace gnomon::ar {

/// What write_model takes, for messages.
inline constexpr std::string_view kWrittenExtensions = ".glb, .gltf, .obj, .ply and .stl";

/// Throws InputError unless the extension names a format that write_model writes.
void check_written_extension(const std::filesystem::path& path);

/// Writes a model in the format that the extension names: .glb or .gltf (one file, all embedded)
/// with materials, textures and colours; .obj (without materials), .ply and .stl (binary) with the
/// triangles alone. Positions keep their bits in all but .obj, which has 9 digits or fewer.
/// Writes `path` itself: give it a PendingFile's temporary name. Throws InputError if it cannot.
/// Precondition: the model has a triangle; normals, texture coordinates and colours are one a
/// position or absent.
void write_model(const std::filesystem::path& path, const pipeline::Model& model);

}  // namespace gnomon::ar
