// The structure of a PLY file, walked from end to end before assimp sees it: assimp 5.2 never comes
// back from a text that breaks off. Source: the PLY format (Turk 1994). Internal to ar/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace gnomon::ar {

/// Throws InputError ("FILE: PLY: what is wrong") unless every element that the header announces is
/// there, whole, and of numbers.
void check_ply_bytes(std::span<const std::uint8_t> bytes, const std::filesystem::path& path);

}  // namespace gnomon::ar
