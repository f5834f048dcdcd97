#include "apps/video_frames.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/output_folder.h"
#include "apps/study/part_file.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"

namespace gnomon::apps {

namespace fs = std::filesystem;

namespace {

constexpr const char* kParts = "video";

fs::path frame_file(const fs::path& out, std::size_t frame) {
  return out / "frames" / fmt::format("{:06}.png", frame);
}

fs::path video_file(const fs::path& out) { return out / "composite.avi"; }

struct VideoPart {
  VideoShape shape;
  std::vector<std::size_t> done;
};

VideoPart read_video_part(const fs::path& file) {
  VideoPart part;
  study::read_part(file, kVideoPartFormat, [&](const nlohmann::json& document) {
    const auto side = [&](std::size_t axis) {
      return static_cast<int>(study::count_in(document.at("size").at(axis), ar::kMaxImageSide));
    };
    part.shape = {side(0), side(1), document.at("frames_per_second").get<double>(),
                  study::count_in(document.at("frames"), study::kMostJobs),
                  document.at("what").get<std::string>()};
    part.done = study::jobs_in(document.at("done"), part.shape.frames,
                               study::shard_in(document.at("shard")));
    const double rate = part.shape.frames_per_second;
    if (part.shape.width < 1 || part.shape.height < 1 || !std::isfinite(rate) || !(rate > 0))
      throw ar::InputError("size or frames_per_second: out of range");
  });
  return part;
}

}  // namespace

VideoFrames::VideoFrames(const fs::path& out, const ar::VideoReader& reader, std::string what,
                         const study::Shard& shard)
    : out_(out),
      shard_(shard),
      shape_{reader.width(), reader.height(), reader.frames_per_second(), 0, std::move(what)} {
  make_folder(out);
  if (shard.is_whole())
    writer_.emplace(video_file(out), shape_.width, shape_.height, shape_.frames_per_second);
  else
    make_folder(out / "frames");
  study::begin_part(out, kParts, shard);
}

void VideoFrames::write(std::size_t frame, const ar::Image& picture) {
  done_.push_back(frame);
  if (writer_)
    writer_->write(picture);
  else
    ar::write_png(frame_file(out_, frame), picture);
}

fs::path VideoFrames::finish(std::size_t frames) {
  if (writer_) {
    writer_->close();
    return video_file(out_);
  }
  const fs::path file = study::part_file(out_, kParts, shard_);
  study::write_part(file, {{"format", kVideoPartFormat},
                           {"shard", {shard_.number, shard_.count}},
                           {"size", {shape_.width, shape_.height}},
                           {"frames_per_second", shape_.frames_per_second},
                           {"frames", frames},
                           {"what", shape_.what},
                           {"done", done_}});
  return file;
}

std::size_t merge_video(const fs::path& out, const std::function<void(std::size_t)>& progress) {
  std::optional<VideoShape> shape;
  std::vector<std::size_t> done;
  for (const fs::path& file : study::find_parts(out, kParts)) {
    const VideoPart part = read_video_part(file);
    if (shape.value_or(part.shape) != part.shape)
      throw ar::InputError(ar::one_line(file.string()) + ": belongs to another video");
    shape = part.shape;
    done.insert(done.end(), part.done.begin(), part.done.end());
  }
  std::ranges::sort(done);
  study::require_every_job(shape->frames, done);
  ar::VideoWriter writer(video_file(out), shape->width, shape->height, shape->frames_per_second);
  for (const std::size_t frame : done) {
    const fs::path file = frame_file(out, frame);
    const ar::Image picture = ar::read_image_rgb(file);
    if (picture.width != shape->width || picture.height != shape->height)
      throw ar::InputError(ar::one_line(file.string()) + ": has another size than the video");
    writer.write(picture);
    progress(frame + 1);
  }
  writer.close();
  return done.size();
}

}  // namespace gnomon::apps
