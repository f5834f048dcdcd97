// Sweeps that need photographs: those of the folder examples/.
#pragma once

#include <filesystem>

#include "apps/study/stability.h"

namespace gnomon::apps::study {

/// Are desk/ and soft/ in that folder?
bool has_photographs(const std::filesystem::path& examples);

/// All of them. Files are read when a sweep runs, which may throw ar::InputError.
void add_photograph_sweeps(Sweeps& sweeps, const std::filesystem::path& examples, int threads);

}  // namespace gnomon::apps::study
