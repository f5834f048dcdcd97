// gnomon inspect: a page that shows a frame from the first command to the last.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/counting.h"
#include "apps/inspector/page.h"
#include "apps/output_folder.h"
#include "apps/page_output.h"
#include "apps/photograph.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/frame_file.h"
#include "ar/image_file.h"
#include "ar/render_scene.h"
#include "ar/scene_file.h"
#include "ar/session.h"
#include "raster/frame_format.h"

namespace gnomon::apps {
namespace {

namespace fs = std::filesystem;
using inspector::PageFrame;

struct Options {
  fs::path input, image, out, lit_scene;
  std::string method, compare;
  int samples = 1;
};

bool is_frame(const fs::path& path) {
  std::string begin(12, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return file && begin == "gnomon frame";
}

PageFrame frame_of_file(const fs::path& path) {
  // Read as a frame, so that a page is made of nothing else.
  const raster::RecordedFrame recorded = ar::read_frame(path);
  if (recorded.frame.command_count() == 0)
    throw ar::InputError(path.string() + ": the frame has no command");
  return {path.filename().string(), raster::encode_frame(recorded.frame)};
}

PageFrame frame_of_photograph(const ar::SceneFile& scene, const Options& options,
                              const std::string& method) {
  const ar::Image picture = ar::read_image_rgb(options.image);
  ar::SessionOptions session_options;
  session_options.differential = method == "differential";
  if (!session_options.differential) session_options.method = counting_named(method);
  session_options.lit_scene = options.lit_scene;
  session_options.still = true;
  session_options.frame = true;
  session_options.masks = false;
  session_options.samples = options.samples;
  ar::Session session(scene, picture.width, picture.height, session_options);
  ar::SessionResult result = augment_photograph(session, picture, options.image);
  return {method.empty() ? "the scene's method" : method, std::move(result.augmented->frame)};
}

PageFrame frame_of_scene(const ar::SceneFile& scene, const std::string& method) {
  ar::RenderOptions render;
  render.frame = true;
  render.counting = counting_named(method);
  ar::Rendered rendered = ar::render_scene(scene, render);
  for (const std::string& note : rendered.notes) std::cerr << "gnomon: note: " << note << '\n';
  return {method.empty() ? "the scene's method" : method, std::move(rendered.frame)};
}

PageFrame frame_of(const Options& options, const std::string& method) {
  if (is_frame(options.input)) {
    if (!method.empty())
      throw ar::InputError(options.input.string() +
                           ": a frame has its method already; compare it with another frame");
    return frame_of_file(options.input);
  }
  const ar::SceneFile scene = ar::read_scene(options.input);
  if (!options.image.empty()) return frame_of_photograph(scene, options, method);
  if (method == "differential")
    throw ar::InputError("--method differential needs --image, the photograph");
  return frame_of_scene(scene, method);
}

PageFrame compared_frame(const Options& options) {
  constexpr std::array<std::string_view, 4> kMethods{"zpass", "zfail", "auto", "differential"};
  if (std::ranges::count(kMethods, options.compare) > 0) return frame_of(options, options.compare);
  if (is_frame(options.compare)) return frame_of_file(options.compare);
  throw ar::InputError("--compare: '" + ar::one_line(options.compare) +
                       "' is no method (zpass, zfail, auto, differential) and no frame file");
}

void check_arguments(const Options& options) {
  if (options.image.empty() && (options.samples != 1 || !options.lit_scene.empty()))
    throw ar::InputError("--samples and --lit-scene go with --image");
  if (!options.image.empty() && is_frame(options.input))
    throw ar::InputError("--image goes with a scene file; " + options.input.string() +
                         " is a frame");
  for (const fs::path& input :
       {options.input, options.image, options.lit_scene, fs::path(options.compare)})
    refuse_to_replace(input, options.out);
}

void inspect(const Options& options) {
  check_arguments(options);
  check_page_folder(options.out);
  std::vector<PageFrame> frames{frame_of(options, options.method)};
  if (!options.compare.empty()) frames.push_back(compared_frame(options));
  write_page(options.out, inspector::inspect_page(options.input.filename().string(), frames));
}

}  // namespace

void add_inspect(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "inspect", "Make a page that shows every buffer, every count and every fragment's fate");
  command
      ->add_option("input", options->input,
                   "Scene file (TOML, docs/scene.md) or recorded frame (docs/frame-format.md)")
      ->required();
  command->add_option("--image", options->image, "Photograph; without it the scene is rendered");
  command->add_option("--out", options->out, "The page, such as page.html")->required();
  command
      ->add_option("--method", options->method,
                   "How shadows are found (default: the scene's), as for gnomon ar")
      ->check(CLI::IsMember({"zpass", "zfail", "auto", "differential"}));
  command->add_option("--compare", options->compare,
                      "zpass, zfail, auto, differential or a frame file, to see side by side");
  command->add_option("--lit-scene", options->lit_scene,
                      "What gnomon capture wrote, for differential shadows");
  command
      ->add_option("--samples", options->samples,
                   "Drawn pixels a photograph's pixel, along x and y (gnomon ar takes 2 or 4)")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command->footer(
      "The page is one file with the rasterizer inside: it opens from disk, needs no network, and\n"
      "executes the frame in the browser. Its help is behind the key h.\n"
      "\n"
      "Examples:\n"
      "  gnomon inspect examples/desk/01_torus_on_house.toml --image examples/desk/background.png "
      "--out page.html\n"
      "  gnomon inspect examples/kuehl/both_methods.toml --out page.html --method zpass --compare "
      "zfail\n"
      "  gnomon inspect golden/frames/desk-04-zpass.frame --compare "
      "golden/frames/desk-04-zfail.frame "
      "--out page.html");
  command->callback([options] { inspect(*options); });
}

}  // namespace gnomon::apps
