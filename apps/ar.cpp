#include <exception>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/ar_arguments.h"
#include "apps/commands.h"
#include "apps/counting.h"
#include "ar/error.h"

namespace gnomon::apps {

namespace {

/// "16ms", "16" or "0.016s".
double milliseconds(const std::string& text) {
  std::size_t end = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  const std::string unit = text.substr(end);
  if (unit == "s") value *= 1000.0;
  if (end == 0 || (unit != "" && unit != "ms" && unit != "s") ||
      !(value >= 0.1 && value <= 60'000.0))
    throw ar::InputError("--budget: '" + text + "' is no time from 0.1ms to 60s, such as 16ms");
  return value;
}

void run(ArArguments& arguments) {
  const int inputs = !arguments.image.empty() + !arguments.video.empty() + (arguments.camera >= 0);
  if (inputs != 1)
    throw ar::InputError("ar: exactly one of --image, --video and --camera is needed");
  arguments.session.differential = arguments.method == "differential";
  if (!arguments.session.differential) arguments.session.method = counting_named(arguments.method);
  if (arguments.passes > 0) arguments.session.passes = arguments.passes;
  if (!arguments.budget.empty()) arguments.session.budget_ms = milliseconds(arguments.budget);
  arguments.session.still = !arguments.image.empty();
  arguments.session.steps = arguments.steps;
  arguments.session.frame = !arguments.save_frame.empty();
  const bool in_parts = arguments.merge || arguments.shard != "1/1";
  if (in_parts && arguments.video.empty())
    throw ar::InputError("ar: --shard and --merge go with --video");
  if (arguments.out.empty() && !(arguments.show && !in_parts))
    throw ar::InputError("ar: --out is needed");
  if (arguments.show && (in_parts || !arguments.image.empty()))
    throw ar::InputError("ar: --show goes with a whole --video or with --camera");
  if (!arguments.image.empty()) return run_still(arguments);
  if (arguments.steps) throw ar::InputError("ar: --steps goes with --image");
  if (!arguments.save_frame.empty()) throw ar::InputError("ar: --save-frame goes with --image");
  if (arguments.merge) return run_video_merge(arguments);
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
  command->add_option("--out", arguments->out,
                      "Folder for the results; not needed with --show, which then writes nothing");
  command->add_flag("--steps", arguments->steps,
                    "Also write colour, depth and stencil after every pass (photograph only)");
  command->add_option("--save-frame", arguments->save_frame,
                      "Also write the recorded frame here, for gnomon replay (photograph only)");
  command->add_flag(
      "--json", arguments->as_json,
      "One line of JSON: tags, poses, passes, milliseconds a stage (video: a line a frame)");
  command
      ->add_option(
          "--method", arguments->method,
          "How shadows are found (default: the scene's). By volumes: zpass is Haller's and "
          "wrong where the camera stands in a shadow; auto takes zfail there. differential: "
          "soft shadows from the real scene's own light (gnomon capture)")
      ->check(CLI::IsMember({"zpass", "zfail", "auto", "differential"}));
  command->add_option("--lit-scene", arguments->session.lit_scene,
                      "What gnomon capture wrote, for differential shadows (default: the scene's)");
  CLI::Option* passes =
      command
          ->add_option("--passes", arguments->passes,
                       "Sources of light that shadows are made for, at most (default: the scene's, "
                       "or 50)")
          ->check(CLI::Range(1, 100'000));
  command
      ->add_option("--budget", arguments->budget,
                   "As many passes as a frame of this time has room for, such as 16ms")
      ->excludes(passes);
  command->add_flag("--double-shadows", arguments->session.double_shadows,
                    "Darken real surfaces also where they are in a real shadow already (the paper "
                    "to the letter)");
  command->add_flag("--no-filter", arguments->session.no_filter,
                    "Poses as measured, without the jitter filter");
  command
      ->add_option(
          "--samples", arguments->session.samples,
          "Drawn pixels a photograph's pixel, along x and y (0: the scene's, or 4 with lens "
          "distortion, else 2)")
      ->check(CLI::Range(0, 8));
  command->add_option("--threads", arguments->session.threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
  command
      ->add_option("--frames", arguments->frames,
                   "Stop a video or camera after so many frames (0: at its end)")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--show", arguments->show,
                    "Show a video or camera in a window as it is drawn; h there lists the keys for "
                    "colour, depth, stencil and passes");
  command->add_option("--shard", arguments->shard,
                      "Draw part I of N of a video's frames (I/N), for a scheduler; then --merge");
  command->add_flag("--merge", arguments->merge,
                    "Make the video of the parts that lie in the folder");
  command->footer(
      "Writes composite.png, shadow_mask.png, shadow_on_virtual.png, object_mask.png and\n"
      "stencil_counts.png; for a video composite.avi (a part: frames/ and video-I-of-N.json).\n"
      "Examples:\n"
      "  gnomon ar examples/desk/01_torus_on_house.toml --image examples/desk/background.png --out "
      "out --steps\n"
      "  gnomon ar scene.toml --video clip.avi --out out --method zfail --json\n"
      "  gnomon ar scene.toml --camera 0 --show\n"
      "  gnomon ar scene.toml --video clip.avi --out out --shard 2/8   # then --merge\n"
      "  gnomon ar examples/soft/suzanne.toml --image examples/soft/background.png --out out "
      "--method differential --passes 100");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace gnomon::apps
