// What `gnomon ar` was asked, and its two jobs.
#pragma once

#include <filesystem>
#include <string>

#include "ar/session.h"

namespace gnomon::apps {

struct ArArguments {
  std::filesystem::path scene, image, video, out;
  int camera = -1;
  bool steps = false, as_json = false;
  std::string method;
  int frames = 0;
  ar::SessionOptions session;
};

/// A photograph: composite, masks, counts, steps. Throws ar::InputError.
void run_still(const ArArguments& arguments);

/// A video file or a live camera: composite.avi. Throws ar::InputError.
void run_video(const ArArguments& arguments);

/// Before any work: could the folder be made, or written to? Throws ar::InputError if not.
void check_folder(const std::filesystem::path& out);

/// Throws ar::InputError if both are one file.
void refuse_to_replace(const std::filesystem::path& input, const std::filesystem::path& output);

/// Makes the folder for results if it is not there. Throws ar::InputError unless it can be written.
void make_folder(const std::filesystem::path& out);

}  // namespace gnomon::apps
