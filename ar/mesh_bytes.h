// The outer form of mesh files, looked at before a reader does: which format it is, and whether the
// counts that its header promises fit the bytes that are there. Readers allocate what a header
// says, and assimp 5.2 reads behind the end of some files that break their promise.
// Sources: the PLY format (Turk 1994), the STL specification (3D Systems 1989), OFF (Geomview), 3DS
// (chunks of 6 bytes and more, as in lib3ds).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace gnomon::ar {

enum class MeshFormat { unknown, gltf, obj, off, stl, ply, three_ds };

/// Extensions of the formats that are read, for messages.
inline constexpr std::string_view kMeshExtensions = ".glb, .gltf, .obj, .off, .stl, .ply and .3ds";

/// By contents where they say it (all but OBJ have a mark), else by extension.
MeshFormat mesh_format(std::span<const std::uint8_t> bytes, const std::filesystem::path& path);

/// Throws InputError ("FILE: what is wrong") unless the header's counts can be met by the bytes.
/// glTF is not looked at: its own reader does that.
void check_mesh_bytes(MeshFormat format, std::span<const std::uint8_t> bytes,
                      const std::filesystem::path& path);

}  // namespace gnomon::ar
