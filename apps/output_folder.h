// The folder that a command writes its results to.
#pragma once

#include <filesystem>
#include <vector>

namespace gnomon::apps {

/// Before any work: could the folder be made, or written to? Throws ar::InputError if not.
void check_folder(const std::filesystem::path& out);

/// Throws ar::InputError if both are one file.
void refuse_to_replace(const std::filesystem::path& input, const std::filesystem::path& output);

/// Before any work: could a recorded frame be written there? Nothing for an empty path. Throws
/// ar::InputError if not, if it is named like a picture, or if it is one of the inputs.
void check_frame_target(const std::filesystem::path& frame,
                        const std::vector<std::filesystem::path>& inputs);

/// Makes the folder for results if it is not there. Throws ar::InputError unless it can be written.
void make_folder(const std::filesystem::path& out);

}  // namespace gnomon::apps
