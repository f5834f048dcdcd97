// What `gnomon ar` was asked, and its two jobs.
#pragma once

#include <filesystem>
#include <string>

#include "ar/session.h"

namespace gnomon::apps {

struct ArArguments {
  std::filesystem::path scene, image, video, out, save_frame;
  int camera = -1;
  bool steps = false, as_json = false, show = false;
  /// Of a video: the part of its frames that is drawn (study/shard.h), or all parts put together.
  std::string shard = "1/1";
  bool merge = false;
  std::string method, budget;
  int frames = 0, passes = 0;
  ar::SessionOptions session;
};

/// A photograph: composite, masks, counts, steps. Throws ar::InputError.
void run_still(const ArArguments& arguments);

/// A video file or a live camera: composite.avi, or a part of its frames, or both beside a window
/// or the window alone. Throws ar::InputError.
void run_video(const ArArguments& arguments);

/// The parts of a video put together: composite.avi. Throws ar::InputError.
void run_video_merge(const ArArguments& arguments);

}  // namespace gnomon::apps
