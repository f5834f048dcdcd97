// What `gnomon ar` was asked, and its two jobs.
#pragma once

#include <filesystem>
#include <string>

#include "ar/session.h"

namespace gnomon::apps {

struct ArArguments {
  std::filesystem::path scene, image, video, out, save_frame;
  int camera = -1;
  bool steps = false, as_json = false;
  std::string method, budget;
  int frames = 0, passes = 0;
  ar::SessionOptions session;
};

/// A photograph: composite, masks, counts, steps. Throws ar::InputError.
void run_still(const ArArguments& arguments);

/// A video file or a live camera: composite.avi. Throws ar::InputError.
void run_video(const ArArguments& arguments);

}  // namespace gnomon::apps
