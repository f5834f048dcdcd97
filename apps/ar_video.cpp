#include <algorithm>
#include <iostream>
#include <optional>

#include <fmt/format.h>

#include "apps/ar_arguments.h"
#include "apps/ar_json.h"
#include "apps/live_window.h"
#include "apps/output_folder.h"
#include "apps/progress.h"
#include "apps/study/shard.h"
#include "apps/video_frames.h"
#include "ar/error.h"
#include "ar/session_options.h"
#include "ar/video.h"

namespace gnomon::apps {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct VideoSummary {
  std::int64_t frames = 0, augmented = 0, without_pose = 0, held = 0, missing = 0;
  double track_ms = 0.0, draw_ms = 0.0;

  void add(const ar::SessionResult& result) {
    ++frames;
    track_ms += result.track_ms;
    if (!result.augmented) {
      ++without_pose;
      return;
    }
    ++augmented;
    held +=
        result.track.world.held || std::ranges::any_of(result.track.bodies, &ar::BodyTrack::held);
    const ar::Augmented& a = *result.augmented;
    draw_ms += a.resample_ms + a.record_ms + a.execute_ms + a.composite_ms;
  }
};

/// What parts of one video agree on, beside the video itself.
std::string asked_for(const ArArguments& arguments) {
  const ar::SessionOptions& session = arguments.session;
  return fmt::format("{} {} {} method '{}' passes {} samples {}{}{}", arguments.scene.string(),
                     arguments.video.string(), session.lit_scene.string(), arguments.method,
                     arguments.passes, session.samples,
                     session.double_shadows ? " double shadows" : "",
                     session.no_filter ? " no filter" : "");
}

void print_frame(const ar::VideoFrame& frame, const ar::SessionResult& result) {
  json line = {{"frame", frame.index},
               {"time_s", frame.time_s},
               {"tags", detections_json(result.track)},
               {"poses", poses_json(result)},
               {"left_out", result.left_out},
               {"augmented", result.augmented.has_value()},
               {"ms", stages_json(result)}};
  if (result.differential) line["differential"] = differential_json(*result.differential);
  std::cout << line.dump() << '\n';
}

void print_summary(const VideoSummary& summary, bool as_json) {
  const double count = static_cast<double>(std::max<std::int64_t>(summary.frames, 1));
  const double drawn = static_cast<double>(std::max<std::int64_t>(summary.augmented, 1));
  if (as_json) {
    std::cout << json{{"frames", summary.frames},
                      {"augmented", summary.augmented},
                      {"without_pose", summary.without_pose},
                      {"held", summary.held},
                      {"missing", summary.missing},
                      {"ms_a_frame",
                       {{"track", summary.track_ms / count}, {"draw", summary.draw_ms / drawn}}}}
                     .dump()
              << '\n';
    return;
  }
  std::cout << fmt::format(
      "{} frames: {} augmented ({} with a held pose), {} without a pose kept as they "
      "are; {:.1f} ms tracking and {:.1f} ms drawing a frame\n",
      summary.frames, summary.augmented, summary.held, summary.without_pose,
      summary.track_ms / count, summary.draw_ms / drawn);
  if (summary.missing > 0)
    std::cout << fmt::format("the video ends early: its header promises {} frames more\n",
                             summary.missing);
}

}  // namespace

void run_video(const ArArguments& arguments) {
  const ar::SceneFile scene = ar::read_scene(arguments.scene);
  ar::VideoReader reader = arguments.camera >= 0 ? ar::VideoReader::open_camera(arguments.camera)
                                                 : ar::VideoReader::open_file(arguments.video);
  ar::SessionOptions options = arguments.session;
  options.masks = false;
  const study::Shard shard = study::parse_shard("--shard", arguments.shard);
  const auto differential = ar::differential_file(scene, options);
  if (!shard.is_whole() && differential && differential->settings.budget_ms > 0.0)
    throw ar::InputError("--shard: not with a budget of time, whose frames depend on those before");
  ar::Session session(scene, reader.width(), reader.height(), options);
  for (const std::string& note : session.notes()) std::cerr << "gnomon: note: " << note << '\n';
  std::optional<VideoFrames> frames;
  if (!arguments.out.empty()) {
    check_folder(arguments.out);
    refuse_to_replace(arguments.video, arguments.out / "composite.avi");
    frames.emplace(arguments.out, reader, asked_for(arguments), shard);
  }
  std::optional<LiveWindow> window;
  if (arguments.show) window.emplace(arguments.scene.filename().string());

  VideoSummary summary;
  std::size_t number = 0;
  bool ended = false;
  {
    std::optional<std::int64_t> total = reader.promised_frames();
    if (arguments.frames > 0)
      total = std::min<std::int64_t>(total.value_or(arguments.frames), arguments.frames);
    const Progress progress("frame", total);
    for (; arguments.frames == 0 || number < static_cast<std::size_t>(arguments.frames); ++number) {
      const std::optional<ar::VideoFrame> frame = reader.next();
      if (!frame) break;
      const bool draw = !frames || frames->wants(number);
      if (window) session.keep_steps(window->wants_steps());
      const ar::SessionResult result = session.process(frame->image, frame->time_s, draw);
      progress.show(static_cast<std::int64_t>(number) + 1);
      if (!draw) continue;
      const ar::Image& drawn = result.augmented ? result.augmented->composite : frame->image;
      if (frames) frames->write(number, drawn);
      summary.add(result);
      if (arguments.as_json) print_frame(*frame, result);
      if (window && !window->show(drawn, result)) {
        ++number;
        ended = true;
        break;
      }
    }
  }
  const fs::path written = frames ? frames->finish(number) : fs::path();
  if (!ended) summary.missing = reader.missing_frames();
  print_summary(summary, arguments.as_json);
  if (!arguments.as_json && !written.empty()) std::cout << "wrote " << written.string() << '\n';
}

void run_video_merge(const ArArguments& arguments) {
  check_folder(arguments.out);
  refuse_to_replace(arguments.video, arguments.out / "composite.avi");
  std::size_t frames = 0;
  {
    const Progress progress("frame", std::nullopt);
    frames = merge_video(arguments.out,
                         [&](std::size_t done) { progress.show(static_cast<std::int64_t>(done)); });
  }
  std::cout << fmt::format("{} frames; wrote {}\n", frames,
                           (arguments.out / "composite.avi").string());
}

}  // namespace gnomon::apps
