// A scene file with what changed in it, beside the models that it needs.
#pragma once

#include <filesystem>

#include "ar/fit_scene.h"

namespace gnomon::ar {

/// Writes `fitted` to FOLDER/scene.toml, and each model that is not the given scene's own to
/// FOLDER/models/NAME.glb; makes that folder. The given file is parsed anew and only what changed
/// is exchanged: everything else stays, but for comments, and paths are made relative to
/// `lives_in`, where the folder's files will be used. Where read_scene reads it there, the result
/// says what `fitted` does. Preconditions: the folder exists; `fitted` came from `given`.
/// Throws InputError if something cannot be written.
void write_fit_scene(const FitScene& given, const FitScene& fitted,
                     const std::filesystem::path& folder, const std::filesystem::path& lives_in);

}  // namespace gnomon::ar
