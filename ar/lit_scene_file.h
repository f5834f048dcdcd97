// A lit scene as a file: JSON whose long rows of numbers are base64 of little-endian bytes, so that
// every float comes back as it was. Format: docs/capture.md.
#pragma once

#include <filesystem>

#include "pipeline/lit_scene.h"

namespace gnomon::ar {

/// Of the file, in bytes.
inline constexpr std::uint64_t kMaxLitSceneBytes = std::uint64_t{24} << 20;

/// Writes beside the file, then renames. Throws InputError when it cannot be written or would be
/// larger than kMaxLitSceneBytes. Precondition: what read_lit_scene checks holds, and each patch is
/// what pipeline::make_patch makes of its vertices.
void write_lit_scene(const std::filesystem::path& file, const pipeline::LitScene& scene);

/// Exactly what was written. Throws InputError in one line: not this format or version, sizes that
/// do not fit each other, an index without a target, a patch without area, a number that is not
/// finite or out of its range (normals of unit length, radiance 0 or more, reflectance in [0, 1], a
/// tone curve that rises).
pipeline::LitScene read_lit_scene(const std::filesystem::path& file);

}  // namespace gnomon::ar
