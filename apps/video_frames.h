// Where the frames of a video go: into the video file, or, where processes share the work, each as
// a picture of its own, out of which the file is made when all parts are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/study/shard.h"
#include "ar/image.h"
#include "ar/video.h"

namespace gnomon::apps {

inline constexpr const char* kVideoPartFormat = "gnomon-video-part 1";

/// What all parts of a video agree on.
struct VideoShape {
  int width = 0, height = 0;
  double frames_per_second = 0.0;
  /// Of the whole, whoever draws them.
  std::size_t frames = 0;
  /// The scene and what else was asked for, in words.
  std::string what;
  bool operator==(const VideoShape&) const = default;
};

/// Takes frames one after another. The whole video is OUT/composite.avi; a part is
/// OUT/frames/NNNNNN.png for its own frames and OUT/video-I-of-N.json.
class VideoFrames {
 public:
  /// Throws ar::InputError.
  VideoFrames(const std::filesystem::path& out, const ar::VideoReader& reader, std::string what,
              const study::Shard& shard);

  /// Is the frame with that number, from 0, one that is to be drawn and written?
  bool wants(std::size_t frame) const { return shard_.has(frame); }
  /// Precondition: it wants the frame. Throws ar::InputError.
  void write(std::size_t frame, const ar::Image& picture);
  /// After the last frame. Throws ar::InputError. Returns the file that says it is complete.
  std::filesystem::path finish(std::size_t frames);

 private:
  std::filesystem::path out_;
  study::Shard shard_;
  VideoShape shape_;
  std::vector<std::size_t> done_;
  std::optional<ar::VideoWriter> writer_;
};

/// Makes OUT/composite.avi of the parts that lie in OUT, with the bytes that one process would have
/// written; `progress` is told how many frames are done. Returns how many there are. Throws
/// ar::InputError: a part or a frame is missing, parts of different videos.
std::size_t merge_video(const std::filesystem::path& out,
                        const std::function<void(std::size_t)>& progress);

}  // namespace gnomon::apps
