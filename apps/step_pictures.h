// The buffers after every pass as files.
#pragma once

#include <filesystem>
#include <vector>

#include "ar/pass_pictures.h"

namespace gnomon::apps {

/// Writes OUT/steps/NN_LABEL_color.png, _depth.png and _stencil.png. Throws ar::InputError.
void write_steps(const std::filesystem::path& out, const std::vector<ar::PassPictures>& steps);

}  // namespace gnomon::apps
