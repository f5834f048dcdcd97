#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/counting.h"
#include "apps/output_folder.h"
#include "apps/step_pictures.h"
#include "ar/error.h"
#include "ar/frame_file.h"
#include "ar/image_file.h"
#include "ar/render_scene.h"
#include "ar/scene_file.h"
#include "raster/frame.h"

namespace gnomon::apps {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

struct Options {
  fs::path scene, out, save_frame;
  std::string method = "additive", counting, size;
  bool json = false;
  ar::RenderOptions render;
};

void parse_size(const std::string& size, ar::RenderOptions& options) {
  if (size.empty()) return;
  char rest = 0;
  const bool read =
      std::sscanf(size.c_str(), "%5dx%5d%c", &options.width, &options.height, &rest) == 2;
  const auto fits = [](int pixels) { return pixels >= 1 && pixels <= raster::kMaxTargetSize; };
  if (!read || !fits(options.width) || !fits(options.height))
    throw ar::InputError(
        fmt::format("--size {}: not WIDTHxHEIGHT, each 1 to {}", size, raster::kMaxTargetSize));
}

void print_json(const Options& options, const ar::Rendered& rendered) {
  ordered_json passes = ordered_json::array(), checks = ordered_json::array();
  for (const ar::PassNote& pass : rendered.passes)
    passes.push_back({{"label", pass.label}, {"commands", pass.commands}});
  for (const ar::RayCheck& check : rendered.checks) {
    checks.push_back({{"light", check.light},
                      {"pixels", check.tested},
                      {"in_shadow", check.in_shadow},
                      {"too_dark", check.too_dark},
                      {"too_light", check.too_light}});
    if (check.differ_from_drawn) checks.back()["differ_from_drawn"] = *check.differ_from_drawn;
  }
  ordered_json line{{"scene", options.scene.string()},
                    {"size", {rendered.picture.width, rendered.picture.height}},
                    {"objects", rendered.objects},
                    {"triangles", rendered.triangles},
                    {"lights", rendered.lights},
                    {"left_out", rendered.left_out},
                    {"passes", passes},
                    {"ms", {{"record", rendered.record_ms}, {"execute", rendered.execute_ms}}}};
  if (options.render.rays) line["rays"] = checks;
  std::cout << line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void print_text(const Options& options, const ar::Rendered& rendered) {
  std::cout << fmt::format(
      "{}: {} objects, {} triangles, {} lights, {} passes; recorded in {:.1f} ms, executed in "
      "{:.1f} ms\n",
      options.scene.string(), rendered.objects, rendered.triangles, rendered.lights,
      rendered.passes.size(), rendered.record_ms, rendered.execute_ms);
  for (const ar::RayCheck& check : rendered.checks) {
    std::cout << fmt::format(
        "light '{}': of {} px that it would light rays see {} in shadow; {} px are too dark, {} "
        "too light\n",
        check.light, check.tested, check.in_shadow, check.too_dark, check.too_light);
    if (check.differ_from_drawn)
      std::cout << fmt::format(
          "light '{}': {} px differ from rays to the models in whose place shadow models cast\n",
          check.light, *check.differ_from_drawn);
  }
  std::cout << "wrote " << (options.out / "picture.png").string() << '\n';
}

void render(Options& options) {
  parse_size(options.size, options.render);
  if (options.method == "modulative") options.render.method = ar::RenderMethod::modulative;
  if (options.render.method == ar::RenderMethod::modulative && options.render.rays)
    throw ar::InputError("--rays goes with --method additive");
  options.render.counting = counting_named(options.counting);
  options.render.frame = !options.save_frame.empty();
  const ar::SceneFile scene = ar::read_scene(options.scene);
  const std::vector<fs::path> inputs = ar::input_files(scene);
  check_folder(options.out);
  if (options.render.steps) check_folder(options.out / "steps");
  for (const fs::path& input : inputs)
    for (const char* name : {"picture.png", "wrong.png"})
      refuse_to_replace(input, options.out / name);
  check_frame_target(options.save_frame, inputs);
  const ar::Rendered rendered = ar::render_scene(scene, options.render);
  for (const std::string& note : rendered.notes) std::cerr << "gnomon: note: " << note << '\n';
  for (const std::string& name : rendered.left_out)
    std::cerr << "gnomon: note: object '" << name
              << "' is left out: it hangs on a body, which only tags can place\n";
  make_folder(options.out);
  ar::write_png(options.out / "picture.png", rendered.picture);
  if (options.render.rays) ar::write_png(options.out / "wrong.png", rendered.wrong);
  if (options.render.steps) write_steps(options.out, rendered.steps);
  if (options.render.frame) ar::write_frame(options.save_frame, rendered.frame);
  if (options.json)
    print_json(options, rendered);
  else
    print_text(options, rendered);
}

}  // namespace

void add_render(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "render", "Draw a scene with its shadows: volumes, shadow maps or both, light by light");
  command->add_option("scene", options->scene, "Scene file (TOML, docs/scene.md)")->required();
  command->add_option("--out", options->out, "Folder for the results")->required();
  command->add_option("--size", options->size,
                      "WIDTHxHEIGHT in pixels (default: the camera's, or 640x480)");
  command
      ->add_option("--method", options->method,
                   "additive: light is added where no shadow is; modulative: a dark quad takes it "
                   "away, and every shadow is a volume")
      ->check(CLI::IsMember({"additive", "modulative"}))
      ->capture_default_str();
  command
      ->add_option("--counting", options->counting,
                   "How volumes are counted (default: the scene's [shadow].method)")
      ->check(CLI::IsMember({"zpass", "zfail", "auto"}));
  command->add_flag("--rays", options->render.rays,
                    "Also compare each light's hard shadows with rays, and write wrong.png: red "
                    "where too dark, blue where too light");
  command->add_flag(
      "--steps", options->render.steps,
      "Also write colour, depth and stencil after every pass that draws into the picture");
  command->add_option("--save-frame", options->save_frame,
                      "Also write the recorded frame here, for gnomon replay");
  command->add_option("--threads", options->render.threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->footer(
      "Writes picture.png. A scene without a camera is seen from the front and above.\n"
      "An object's shadow_model, a reduced mesh, casts in the place of the model that is drawn.\n"
      "Examples:\n"
      "  gnomon render examples/kuehl/both_methods.toml --out out\n"
      "  gnomon render examples/kuehl/reduced.toml --out out --rays\n"
      "  gnomon render scene.toml --size 1280x720 --out out --steps --rays\n"
      "  gnomon render scene.toml --method modulative --out out --json");
  command->callback([options] { render(*options); });
}

}  // namespace gnomon::apps
