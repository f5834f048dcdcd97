#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "ar/error.h"
#include "ar/image_file.h"
#include "ar/session.h"
#include "ar/video.h"

namespace gnomon::apps {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct ArArguments {
  fs::path scene, image, video, out;
  int camera = -1;
  bool steps = false, as_json = false;
  std::string method;
  int frames = 0;
  ar::SessionOptions session;
};

json tag_json(const ar::TagId& id) { return {{"family", id.family}, {"id", id.number}}; }

json matrix_json(const glm::dmat4& m) {
  json rows = json::array();
  for (int r = 0; r < 4; ++r) rows.push_back({m[0][r], m[1][r], m[2][r], m[3][r]});
  return rows;
}

json detections_json(const ar::TrackResult& track) {
  json list = json::array();
  for (const ar::Detection& d : track.detections) {
    json tag = tag_json(d.id);
    for (const glm::dvec2& c : d.corners_px) tag["corners_px"].push_back({c.x, c.y});
    list.push_back(tag);
  }
  return list;
}

json poses_json(const ar::SessionResult& result) {
  json poses = {{"world_from_camera", nullptr}, {"rms_px", nullptr}, {"bodies", json::array()}};
  if (result.world_from_camera) poses["world_from_camera"] = matrix_json(*result.world_from_camera);
  if (result.track.world.camera_from_body) poses["rms_px"] = result.track.world.rms_px;
  for (const ar::BodyTrack& body : result.track.bodies) {
    json entry = {{"name", body.name}, {"held", body.held}, {"world_from_body", nullptr}};
    if (body.world_from_body) {
      entry["world_from_body"] = matrix_json(*body.world_from_body);
      entry["rms_px"] = body.rms_px;
    }
    poses["bodies"].push_back(entry);
  }
  return poses;
}

json passes_json(const ar::Augmented& augmented) {
  json list = json::array();
  for (const ar::PassNote& pass : augmented.passes)
    list.push_back({{"label", pass.label}, {"commands", pass.commands}});
  return list;
}

/// Milliseconds a stage, rounded to microseconds.
json stages_json(const ar::SessionResult& result) {
  const auto ms = [](double v) { return std::round(v * 1000.0) / 1000.0; };
  json stages = {{"track", ms(result.track_ms)}};
  if (const std::optional<ar::Augmented>& a = result.augmented) {
    stages["resample"] = ms(a->resample_ms);
    stages["record"] = ms(a->record_ms);
    stages["execute"] = ms(a->execute_ms);
    stages["composite"] = ms(a->composite_ms);
  }
  return stages;
}

int count_set(const ar::Image& mask) {
  return static_cast<int>(std::ranges::count(mask.pixels, std::uint8_t{255}));
}

void make_folder(const fs::path& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (error || !fs::is_directory(out))
    throw ar::InputError(out.string() + ": cannot make this folder: " +
                         (error ? error.message() : "a file has its name"));
  if (access(out.c_str(), W_OK | X_OK) != 0)
    throw ar::InputError(out.string() + ": this folder cannot be written");
}

/// "step 2: volumes of ..." as part of a file name.
std::string file_name_of(std::string label) {
  for (char& c : label)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  std::string name;
  for (const char c : label)
    if (c != '_' || (!name.empty() && name.back() != '_')) name += c;
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

void write_steps(const fs::path& out, const std::vector<ar::PassPictures>& steps) {
  const fs::path folder = out / "steps";
  make_folder(folder);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::string name = fmt::format("{:02}_{}", i + 1, file_name_of(steps[i].label));
    ar::write_png(folder / (name + "_color.png"), steps[i].color);
    ar::write_png(folder / (name + "_depth.png"), steps[i].depth);
    ar::write_png(folder / (name + "_stencil.png"), steps[i].stencil);
  }
}

void report_left_out(const ar::SessionResult& result) {
  for (const std::string& name : result.left_out)
    std::cerr << "gnomon: note: object '" << name
              << "' is left out: its body's tags are not seen\n";
}

void run_still(const ArArguments& arguments) {
  const ar::SceneFile scene = ar::read_scene(arguments.scene);
  const ar::Image picture = ar::read_image_rgb(arguments.image);
  ar::Session session(scene, picture.width, picture.height, arguments.session);
  for (const std::string& note : session.notes()) std::cerr << "gnomon: note: " << note << '\n';
  const ar::SessionResult result = session.process(picture, 0.0);
  if (!result.augmented)
    throw ar::InputError(fmt::format(
        "{}: no pose for any virtual object: {} tags found, none of the scene's that "
        "are needed ({})",
        arguments.image.string(), result.track.detections.size(), session.known_tags()));
  const ar::Augmented& augmented = *result.augmented;
  make_folder(arguments.out);
  ar::write_png(arguments.out / "composite.png", augmented.composite);
  ar::write_png(arguments.out / "shadow_mask.png", augmented.shadow_mask);
  ar::write_png(arguments.out / "shadow_on_virtual.png", augmented.shadow_on_virtual);
  ar::write_png(arguments.out / "object_mask.png", augmented.object_mask);
  ar::write_png(arguments.out / "stencil_counts.png", augmented.stencil_counts);
  if (arguments.steps) write_steps(arguments.out, augmented.steps);

  if (arguments.as_json) {
    const json line = {{"image", arguments.image.string()},
                       {"tags", detections_json(result.track)},
                       {"poses", poses_json(result)},
                       {"left_out", result.left_out},
                       {"view", {session.view().width(), session.view().height()}},
                       {"passes", passes_json(augmented)},
                       {"pixels",
                        {{"shadow", count_set(augmented.shadow_mask)},
                         {"shadow_on_virtual", count_set(augmented.shadow_on_virtual)},
                         {"object", count_set(augmented.object_mask)}}},
                       {"ms", stages_json(result)}};
    std::cout << line.dump() << '\n';
    return;
  }
  report_left_out(result);
  std::cout << fmt::format(
      "{}: {} tags, {} passes, {} px of virtual objects, {} px of shadow on real "
      "surfaces, {} px of real shadow on virtual ones\n",
      arguments.image.string(), result.track.detections.size(), augmented.passes.size(),
      count_set(augmented.object_mask), count_set(augmented.shadow_mask),
      count_set(augmented.shadow_on_virtual));
  std::cout << "wrote " << (arguments.out / "composite.png").string() << " and its masks\n";
}

/// Frames done and to do, on a terminal's last line only.
class Progress {
 public:
  explicit Progress(std::optional<std::int64_t> total) : total_(total), shown_(isatty(2) == 1) {}
  ~Progress() {
    if (shown_) std::cerr << "\r\033[K";
  }
  void show(std::int64_t done) const {
    if (!shown_) return;
    if (!total_ || *total_ <= 0) {
      std::cerr << "\rframe " << done << std::flush;
      return;
    }
    constexpr int kWidth = 40;
    const int filled = static_cast<int>(std::min<std::int64_t>(kWidth, done * kWidth / *total_));
    std::cerr << fmt::format("\r[{:<{}}] {}/{}", std::string(filled, '#'), kWidth, done, *total_)
              << std::flush;
  }

 private:
  std::optional<std::int64_t> total_;
  bool shown_;
};

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

void run_video(const ArArguments& arguments) {
  const ar::SceneFile scene = ar::read_scene(arguments.scene);
  ar::VideoReader reader = arguments.camera >= 0 ? ar::VideoReader::open_camera(arguments.camera)
                                                 : ar::VideoReader::open_file(arguments.video);
  ar::SessionOptions options = arguments.session;
  options.masks = false;
  ar::Session session(scene, reader.width(), reader.height(), options);
  for (const std::string& note : session.notes()) std::cerr << "gnomon: note: " << note << '\n';
  make_folder(arguments.out);
  const fs::path target = arguments.out / "composite.avi";
  ar::VideoWriter writer(target, reader.width(), reader.height(), reader.frames_per_second());

  VideoSummary summary;
  {
    std::optional<std::int64_t> total = reader.promised_frames();
    if (arguments.frames > 0)
      total = std::min<std::int64_t>(total.value_or(arguments.frames), arguments.frames);
    const Progress progress(total);
    while (arguments.frames == 0 || summary.frames < arguments.frames) {
      const std::optional<ar::VideoFrame> frame = reader.next();
      if (!frame) break;
      const ar::SessionResult result = session.process(frame->image, frame->time_s);
      writer.write(result.augmented ? result.augmented->composite : frame->image);
      summary.add(result);
      if (arguments.as_json)
        std::cout << json{{"frame", frame->index},
                          {"time_s", frame->time_s},
                          {"tags", detections_json(result.track)},
                          {"poses", poses_json(result)},
                          {"left_out", result.left_out},
                          {"augmented", result.augmented.has_value()},
                          {"ms", stages_json(result)}}
                         .dump()
                  << '\n';
      progress.show(summary.frames);
    }
  }
  writer.close();
  summary.missing = reader.missing_frames();
  const double frames = static_cast<double>(std::max<std::int64_t>(summary.frames, 1));
  const double drawn = static_cast<double>(std::max<std::int64_t>(summary.augmented, 1));
  if (arguments.as_json) {
    std::cout << json{{"frames", summary.frames},
                      {"augmented", summary.augmented},
                      {"without_pose", summary.without_pose},
                      {"held", summary.held},
                      {"missing", summary.missing},
                      {"ms_a_frame",
                       {{"track", summary.track_ms / frames}, {"draw", summary.draw_ms / drawn}}}}
                     .dump()
              << '\n';
    return;
  }
  std::cout << fmt::format(
      "{} frames: {} augmented ({} with a held pose), {} without a pose kept as they "
      "are; {:.1f} ms tracking and {:.1f} ms drawing a frame\n",
      summary.frames, summary.augmented, summary.held, summary.without_pose,
      summary.track_ms / frames, summary.draw_ms / drawn);
  if (summary.missing > 0)
    std::cout << fmt::format("the video ends early: its header promises {} frames more\n",
                             summary.missing);
  std::cout << "wrote " << target.string() << '\n';
}

void run(ArArguments& arguments) {
  const int inputs = !arguments.image.empty() + !arguments.video.empty() + (arguments.camera >= 0);
  if (inputs != 1)
    throw ar::InputError("gnomon ar: exactly one of --image, --video and --camera is needed");
  if (arguments.method == "zpass") arguments.session.method = pipeline::VolumeMethod::zpass;
  if (arguments.method == "zfail") arguments.session.method = pipeline::VolumeMethod::zfail;
  if (arguments.method == "auto") arguments.session.method = pipeline::VolumeMethod::automatic;
  arguments.session.steps = arguments.steps;
  if (!arguments.image.empty()) return run_still(arguments);
  if (arguments.steps) throw ar::InputError("gnomon ar: --steps goes with --image");
  run_video(arguments);
}

}  // namespace

void add_ar(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "ar", "Put virtual objects and their shadows into a photograph or a video with tags");
  auto arguments = std::make_shared<ArArguments>();
  command->add_option("scene", arguments->scene, "Scene file (TOML, docs/scene.md)")->required();
  command->add_option("--image", arguments->image, "Photograph");
  command->add_option("--video", arguments->video, "Video file");
  command->add_option("--camera", arguments->camera, "Number of a live camera")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--out", arguments->out, "Folder for the results")->required();
  command->add_flag("--steps", arguments->steps,
                    "Also write colour, depth and stencil after every pass (photograph only)");
  command->add_flag(
      "--json", arguments->as_json,
      "One line of JSON: tags, poses, passes, milliseconds a stage (video: a line a frame)");
  command
      ->add_option("--method", arguments->method, "How volumes are counted (default: the scene's)")
      ->check(CLI::IsMember({"zpass", "zfail", "auto"}));
  command->add_flag("--double-shadows", arguments->session.double_shadows,
                    "Darken real surfaces also where they are in a real shadow already (the paper "
                    "to the letter)");
  command->add_flag("--no-filter", arguments->session.no_filter,
                    "Poses as measured, without the jitter filter");
  command
      ->add_option(
          "--samples", arguments->session.samples,
          "Drawn pixels a photograph's pixel, along x and y (0: 4 with lens distortion, else 2)")
      ->check(CLI::Range(0, 8));
  command->add_option("--threads", arguments->session.threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--frames", arguments->frames,
                   "Stop a video or camera after so many frames (0: at its end)")
      ->check(CLI::NonNegativeNumber);
  command->footer(
      "Writes composite.png, shadow_mask.png, shadow_on_virtual.png, object_mask.png and\n"
      "stencil_counts.png; for a video composite.avi.\n"
      "Examples:\n"
      "  gnomon ar examples/desk/01_torus_on_house.toml --image examples/desk/background.png --out "
      "out --steps\n"
      "  gnomon ar scene.toml --video clip.avi --out out --method zfail --json");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace gnomon::apps
