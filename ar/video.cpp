#include "ar/video.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>
#include <utility>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"
#include "raster/check.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

namespace {

/// OpenCV and FFmpeg report to the terminal what is reported here by exceptions. Settings of the
/// user's stay.
void silence_codecs() {
  static std::once_flag once;
  std::call_once(once, [] {
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
    // A playlist must not reach the network.
    ::setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", "protocol_whitelist;file,crypto,data", 0);
  });
}

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(fmt::format("{}: {}", one_line(name), one_line(what)));
}

Image rgb_from_bgr(const cv::Mat& frame) {
  Image image{frame.cols, frame.rows, 3, {}};
  image.pixels.resize(static_cast<std::size_t>(frame.cols) * frame.rows * 3);
  std::uint8_t* out = image.pixels.data();
  for (int y = 0; y < frame.rows; ++y) {
    const std::uint8_t* in = frame.ptr<std::uint8_t>(y);
    for (int x = 0; x < frame.cols; ++x, in += 3, out += 3) {
      out[0] = in[2];
      out[1] = in[1];
      out[2] = in[0];
    }
  }
  return image;
}

}  // namespace

struct VideoReader::Impl {
  std::string name;
  bool live = false;
  cv::VideoCapture capture;
  /// Decoded ahead: the frame that next() gives.
  std::optional<VideoFrame> ahead;
  int width = 0, height = 0;
  double fps = 30.0;
  std::optional<std::int64_t> promised;
  std::int64_t read = 0;
  double last_time_s = 0.0, first_time_s = 0.0;
  bool ended = false;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

  double frame_time(std::int64_t index) {
    if (live)
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    double time = capture.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
    // Containers without time stamps report 0 throughout.
    if (!std::isfinite(time) || time < 0.0 || (index > 0 && time <= last_time_s + first_time_s))
      return static_cast<double>(index) / fps;
    if (index == 0) first_time_s = time;
    return time - first_time_s;
  }

  std::optional<VideoFrame> decode(std::int64_t index) {
    cv::Mat frame;
    try {
      if (!capture.read(frame) || frame.empty()) return std::nullopt;
    } catch (const cv::Exception& e) {
      fail(name, fmt::format("frame {}: {}", index, e.what()));
    }
    if (frame.cols > kMaxImageSide || frame.rows > kMaxImageSide || frame.type() != CV_8UC3)
      fail(name, fmt::format("frame {}: {} x {} pixels of {} channels are not read", index,
                             frame.cols, frame.rows, frame.channels()));
    if (index > 0 && (frame.cols != width || frame.rows != height))
      fail(name, fmt::format("frame {}: {} x {} pixels in a video of {} x {}", index, frame.cols,
                             frame.rows, width, height));
    const double time = std::max(frame_time(index), last_time_s);
    last_time_s = time;
    return VideoFrame{rgb_from_bgr(frame), time, index};
  }

  void begin() {
    fps = capture.get(cv::CAP_PROP_FPS);
    if (!std::isfinite(fps) || fps < 0.1 || fps > 1000.0) fps = 30.0;
    ahead = decode(0);
    if (!ahead) fail(name, "no frame can be decoded");
    width = ahead->image.width;
    height = ahead->image.height;
  }
};

VideoReader::VideoReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;
VideoReader::~VideoReader() = default;

VideoReader VideoReader::open_file(const fs::path& path) {
  silence_codecs();
  auto impl = std::make_unique<Impl>();
  impl->name = path.string();
  std::error_code error;
  if (!fs::exists(path, error)) fail(impl->name, "no such file");
  if (!fs::is_regular_file(path, error)) fail(impl->name, "not a regular file");
  try {
    // Absolute, so that no name is taken for an address; one back end, because another would take
    // digits in the name for a series of pictures.
    if (!impl->capture.open(fs::absolute(path).string(), cv::CAP_FFMPEG))
      fail(impl->name, "cannot be opened as a video");
  } catch (const cv::Exception& e) {
    fail(impl->name, e.what());
  }
  const double frames = impl->capture.get(cv::CAP_PROP_FRAME_COUNT);
  if (std::isfinite(frames) && frames >= 1.0 && frames < 1e9)
    impl->promised = static_cast<std::int64_t>(std::llround(frames));
  impl->begin();
  return VideoReader(std::move(impl));
}

VideoReader VideoReader::open_camera(int index) {
  silence_codecs();
  auto impl = std::make_unique<Impl>();
  impl->name = fmt::format("camera {}", index);
  impl->live = true;
  if (index < 0 || index > 99) fail(impl->name, "cameras have numbers 0 to 99");
  try {
    // Not any back end: some search every bus of the machine.
    if (!impl->capture.open(index, cv::CAP_V4L2))
      fail(impl->name, "no such camera, or it is in use");
  } catch (const cv::Exception& e) {
    fail(impl->name, e.what());
  }
  impl->start = std::chrono::steady_clock::now();
  impl->begin();
  return VideoReader(std::move(impl));
}

int VideoReader::width() const { return impl_->width; }
int VideoReader::height() const { return impl_->height; }
double VideoReader::frames_per_second() const { return impl_->fps; }
std::optional<std::int64_t> VideoReader::promised_frames() const { return impl_->promised; }
std::int64_t VideoReader::frames_read() const { return impl_->read; }

std::int64_t VideoReader::missing_frames() const {
  if (!impl_->ended || !impl_->promised) return 0;
  return std::max<std::int64_t>(0, *impl_->promised - impl_->read);
}

std::optional<VideoFrame> VideoReader::next() {
  if (impl_->ended) return std::nullopt;
  std::optional<VideoFrame> frame = std::exchange(impl_->ahead, std::nullopt);
  if (!frame) frame = impl_->decode(impl_->read);
  if (!frame) {
    impl_->ended = true;
    return std::nullopt;
  }
  ++impl_->read;
  return frame;
}

struct VideoWriter::Impl {
  PendingFile file;
  cv::VideoWriter writer;
  int width = 0, height = 0;
  std::int64_t frames = 0;
  bool closed = false;
};

VideoWriter::VideoWriter(const fs::path& path, int width, int height, double frames_per_second) {
  raster::require(width > 0 && height > 0 && frames_per_second > 0.0,
                  "a video's width, height and rate are positive");
  silence_codecs();
  const std::string extension = path.extension().string();
  const bool mp4 = extension == ".mp4";
  if (!mp4 && extension != ".avi")
    fail(path.string(), fmt::format("extension \"{}\" is not .avi or .mp4", extension));
  if (mp4 && (width % 2 != 0 || height % 2 != 0))
    fail(path.string(),
         fmt::format(".mp4 needs an even width and height, not {} x {}; .avi takes any", width,
                     height));
  impl_.reset(new Impl{PendingFile(path), {}, width, height});
  try {
    // FFmpeg's writer keeps the rate but cuts odd sizes; OpenCV's own keeps odd sizes but rounds
    // the rate.
    const bool odd = width % 2 != 0 || height % 2 != 0;
    impl_->writer.open(impl_->file.temporary().string(),
                       odd ? cv::CAP_OPENCV_MJPEG : cv::CAP_FFMPEG,
                       mp4 ? cv::VideoWriter::fourcc('m', 'p', '4', 'v')
                           : cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                       frames_per_second, cv::Size(width, height));
  } catch (const cv::Exception& e) {
    fail(path.string(), e.what());
  }
  if (!impl_->writer.isOpened()) fail(path.string(), "cannot be written as a video");
}

VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;
VideoWriter::~VideoWriter() = default;

std::int64_t VideoWriter::frames_written() const { return impl_->frames; }

void VideoWriter::write(const Image& frame) {
  raster::require(!impl_->closed, "a video that is closed takes no frame");
  raster::require(
      frame.channels == 3 && frame.width == impl_->width && frame.height == impl_->height &&
          frame.pixels.size() == static_cast<std::size_t>(frame.width) * frame.height * 3,
      "a video's frames have three channels and its size");
  cv::Mat bgr(frame.height, frame.width, CV_8UC3);
  const std::uint8_t* in = frame.pixels.data();
  for (int y = 0; y < frame.height; ++y) {
    std::uint8_t* out = bgr.ptr<std::uint8_t>(y);
    for (int x = 0; x < frame.width; ++x, in += 3, out += 3) {
      out[0] = in[2];
      out[1] = in[1];
      out[2] = in[0];
    }
  }
  try {
    impl_->writer.write(bgr);
  } catch (const cv::Exception& e) {
    fail(impl_->file.target().string(), e.what());
  }
  ++impl_->frames;
}

void VideoWriter::close() {
  if (impl_->closed) return;
  impl_->closed = true;
  const std::string name = impl_->file.target().string();
  try {
    impl_->writer.release();
  } catch (const cv::Exception& e) {
    fail(name, e.what());
  }
  if (impl_->frames == 0) fail(name, "a video without a frame is not written");
  std::error_code error;
  if (fs::file_size(impl_->file.temporary(), error) == 0 || error)
    fail(name, "cannot be written: the disk is full or the codec failed");
  impl_->file.commit();
}

}  // namespace gnomon::ar
