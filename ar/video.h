// Moving pictures in and out, by OpenCV: video files and live cameras in, .avi (MJPG) and .mp4
// (mp4v) out. A video file is written beside its target and renamed when it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "ar/image.h"

namespace gnomon::ar {

/// A picture of a video. Time runs from 0 at the first frame; live, by the clock.
struct VideoFrame {
  Image image;
  double time_s = 0.0;
  std::int64_t index = 0;
};

/// Reads frames one after another. The first is decoded when the video is opened, so a reader that
/// exists has a picture.
class VideoReader {
 public:
  /// A video file. Throws InputError: missing, no video, no frame that can be decoded, frames of
  /// more than kMaxImageSide pixels a side.
  static VideoReader open_file(const std::filesystem::path& path);
  /// Camera number `index` of the machine. Throws InputError if there is none or it gives no
  /// picture.
  static VideoReader open_camera(int index);

  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;
  ~VideoReader();

  int width() const;
  int height() const;
  /// Frames a second as the file says; 30 if it does not say anything sensible.
  double frames_per_second() const;
  /// Frames that the file's header promises; absent for cameras and where the file does not say.
  std::optional<std::int64_t> promised_frames() const;

  /// The next frame as r, g, b; nothing at the end. Times never decrease.
  /// Throws InputError if a frame has another size than the first.
  std::optional<VideoFrame> next();

  /// Frames handed out so far.
  std::int64_t frames_read() const;
  /// After the end: frames that the header promised and that are not there (a truncated file). 0
  /// before the end and for cameras.
  std::int64_t missing_frames() const;

 private:
  struct Impl;
  explicit VideoReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Writes frames of one size. Until close() the target is untouched; a writer that is destroyed
/// before leaves nothing behind.
class VideoWriter {
 public:
  /// Throws InputError: an extension other than .avi or .mp4, a folder that cannot be written, an
  /// odd width or height for .mp4.
  /// With an odd width or height an .avi's rate is rounded to a whole number.
  /// Preconditions: width, height and frames_per_second positive.
  VideoWriter(const std::filesystem::path& path, int width, int height, double frames_per_second);
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();

  /// Precondition: three channels, the writer's size; not after close().
  void write(const Image& frame);

  /// Completes the file and renames it. Throws InputError if it cannot be written or has no frame.
  void close();

  std::int64_t frames_written() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::ar
