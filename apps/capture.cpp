#include <iostream>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/output_folder.h"
#include "apps/progress.h"
#include "ar/capture_file.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"
#include "ar/lit_scene_file.h"
#include "ar/patch_picture.h"
#include "ar/scene_light.h"
#include "pipeline/patch_exchange.h"

namespace gnomon::apps {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

struct Options {
  fs::path folder, out, picture;
  bool json = false;
  ar::SceneLightOptions light;
};

std::vector<fs::path> inputs_of(const ar::CaptureFile& capture) {
  std::vector<fs::path> inputs{capture.file, capture.camera, capture.photograph,
                               capture.photograph_brackets, capture.model};
  if (const auto* ball = std::get_if<ar::BallProbe>(&capture.probe))
    inputs.push_back(ball->brackets);
  else
    inputs.push_back(std::get<ar::LatlongProbe>(capture.probe).picture);
  return inputs;
}

/// Before any work. Throws ar::InputError.
void check_output(const ar::CaptureFile& capture, const fs::path& out) {
  for (const fs::path& input : inputs_of(capture)) refuse_to_replace(input, out);
  // Begun and not committed, it leaves nothing behind.
  const ar::PendingFile begun(out);
}

void write_picture(const ar::CaptureFile& capture, const Options& options,
                   const pipeline::LitScene& scene) {
  if (options.picture.empty()) return;
  const ar::Image photograph = ar::read_image_rgb(capture.photograph);
  const ar::CameraModel camera =
      ar::camera_for_picture(ar::read_camera(capture.camera), photograph.width, photograph.height);
  ar::write_png(options.picture,
                ar::patch_picture(scene, camera, capture.world_from_camera, options.light.threads));
}

void print_json(const Options& options, const ar::SceneLight& light) {
  ordered_json ms;
  for (const auto& [name, value] : light.step_ms) ms[name] = value;
  const glm::dvec3 ratio = light.photograph_over_probe;
  const ordered_json line{{"out", options.out.string()},
                          {"patches", light.scene.model.near_count()},
                          {"surfaces", light.scene.model.surfaces.size()},
                          {"from_photograph", light.from_photograph},
                          {"from_probe", light.from_probe},
                          {"filled", light.filled},
                          {"emitting", light.emitting},
                          {"photograph_over_probe", {ratio.x, ratio.y, ratio.z}},
                          {"ms", ms}};
  std::cout << line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void print_text(const Options& options, const ar::SceneLight& light) {
  double ms = 0.0;
  for (const auto& [name, value] : light.step_ms) ms += value;
  const glm::dvec3 ratio = light.photograph_over_probe;
  std::cout << fmt::format(
      "{}: {} patches of {} surfaces: {} from the photograph, {} from the probe, {} filled; {} "
      "shine\n",
      options.folder.string(), light.scene.model.near_count(), light.scene.model.surfaces.size(),
      light.from_photograph, light.from_probe, light.filled, light.emitting);
  std::cout << fmt::format("photograph / probe where both see: {:.3f} {:.3f} {:.3f}\n", ratio.x,
                           ratio.y, ratio.z);
  std::cout << fmt::format("wrote {} ({:.1f} s)\n", options.out.string(), ms / 1000.0);
}

void capture(Options& options) {
  const ar::CaptureFile file = ar::read_capture(options.folder);
  check_output(file, options.out);
  if (!options.picture.empty()) check_output(file, options.picture);
  ar::SceneLight light;
  {
    const Progress progress("step", ar::kSceneLightSteps);
    options.light.progress = [&](const char*, int number) { progress.show(number); };
    light = ar::find_scene_light(file, options.light);
  }
  for (const std::string& note : light.notes) std::cerr << "gnomon: note: " << note << '\n';
  write_picture(file, options, light.scene);
  ar::write_lit_scene(options.out, light.scene);
  if (options.json)
    print_json(options, light);
  else
    print_text(options, light);
}

}  // namespace

void add_capture(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "capture", "Measure the light of a real scene from photographs of it and of a mirror ball");
  command->add_option("folder", options->folder, "Folder with a capture.toml (docs/capture.md)")
      ->required();
  command->add_option("--out", options->out, "Lit scene file to write")->required();
  command
      ->add_option("--patches", options->light.patches, "Instead of the file's number of patches")
      ->check(CLI::Range(1, static_cast<int>(pipeline::PatchExchange::kMostPatches)));
  command
      ->add_option("--samples", options->light.samples,
                   "Cells a side that a probe's pixel is cut in")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  command
      ->add_option("--visibility-samples", options->light.visibility_samples,
                   "Rays that say how much of a patch another one sees")
      ->check(CLI::IsMember({1, 4, 16}))
      ->capture_default_str();
  command->add_option("--threads", options->light.threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
  command->add_option("--picture", options->picture,
                      "Also write here (PNG) the patches as the photograph's camera sees them");
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->footer(
      "Writes one file: patches with radiance and reflectance, the camera's tone curve, a map of\n"
      "the light around the probe.\n"
      "Examples:\n"
      "  gnomon capture examples/soft --out soft.lit\n"
      "  gnomon capture examples/soft --out soft.lit --patches 3000 --picture patches.png --json");
  command->callback([options] { capture(*options); });
}

}  // namespace gnomon::apps
