// Soft shadows from a real scene's own light, as a scene file has them (docs/scene.md,
// [differential]).
#pragma once

#include <filesystem>

#include <toml++/toml.h>

#include "ar/scene_file.h"

namespace gnomon::ar {

/// Throws InputError.
DifferentialFile read_differential(const std::filesystem::path& file, const toml::table& table);

}  // namespace gnomon::ar
