// gnomon fit: the least that a scene needs within an error, measured on its own pictures.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/fit_report.h"
#include "apps/output_folder.h"
#include "apps/progress.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/fit.h"
#include "ar/image_file.h"
#include "ar/scene_writer.h"

namespace gnomon::apps {

namespace fs = std::filesystem;

namespace {

struct Options {
  fs::path scene, out, lit_scene;
  std::vector<fs::path> images;
  std::string error;
  int repeat = 5, threads = 0;
  bool json = false;
};

constexpr const char* kPictures[] = {"before.png", "after.png", "difference.png"};
constexpr const char* kScene = "scene.toml";
constexpr const char* kReports[] = {"report.json", "report.md"};

/// A folder beside the one that is asked for, in which everything is made first; what it holds is
/// moved file by file, and it goes with what is left.
class Staging {
 public:
  explicit Staging(const fs::path& out) {
    const fs::path whole = fs::weakly_canonical(fs::absolute(out));
    std::error_code error;
    fs::create_directories(whole.parent_path(), error);
    std::string name = (whole.parent_path() / ".gnomon-fit-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw ar::InputError(whole.parent_path().string() + ": this folder cannot be written");
    folder_ = name;
    // As other folders are, not for one person alone.
    fs::permissions(folder_, fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec |
                                 fs::perms::others_read | fs::perms::others_exec);
  }
  ~Staging() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const fs::path& folder() const { return folder_; }

  /// Every file, below the folder.
  std::vector<fs::path> files() const {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
      if (entry.is_regular_file()) files.push_back(entry.path().lexically_relative(folder_));
    return files;
  }

  /// Models before the scene that names them.
  void move_to(const fs::path& out) const {
    make_folder(out);
    std::vector<fs::path> files = this->files();
    std::ranges::stable_partition(files,
                                  [](const fs::path& file) { return file.has_parent_path(); });
    for (const fs::path& file : files) {
      if (file.has_parent_path()) make_folder(out / file.parent_path());
      std::error_code error;
      fs::rename(folder_ / file, out / file, error);
      if (error)
        throw ar::InputError((out / file).string() + ": cannot be written: " + error.message());
    }
  }

 private:
  fs::path folder_;
};

/// 128 where both pictures agree, and what one is lighter four times over.
ar::Image difference_picture(const ar::Image& before, const ar::Image& after) {
  ar::Image out = before;
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    out.pixels[i] = static_cast<std::uint8_t>(
        std::clamp(128 + 4 * (after.pixels[i] - before.pixels[i]), 0, 255));
  return out;
}

std::vector<ar::NamedPicture> read_photographs(const std::vector<fs::path>& images) {
  std::vector<ar::NamedPicture> photographs;
  for (const fs::path& image : images)
    photographs.push_back({image.string(), ar::read_image_rgb(image)});
  return photographs;
}

std::vector<fs::path> inputs_of(const Options& options, const ar::SceneFile& scene) {
  std::vector<fs::path> inputs = ar::input_files(scene);
  inputs.insert(inputs.end(), options.images.begin(), options.images.end());
  if (!options.lit_scene.empty()) inputs.push_back(options.lit_scene);
  return inputs;
}

ar::FitResult search(const Options& options, ar::Fitter& fitter,
                     std::optional<Progress>& progress) {
  ar::FitResult result = fitter.search();
  progress.reset();
  for (const std::string& note : result.notes) std::cerr << "gnomon: note: " << note << '\n';
  if (!options.json)
    for (const std::string& name : result.left_out)
      std::cerr << "gnomon: note: object '" << name << "' is in no picture and stays as it is\n";
  return result;
}

void write_pictures(ar::Fitter& fitter, const ar::FitResult& result, const fs::path& folder) {
  const ar::Image before = fitter.show(result.given), after = fitter.show(result.fitted);
  ar::write_png(folder / kPictures[0], before);
  ar::write_png(folder / kPictures[1], after);
  ar::write_png(folder / kPictures[2], difference_picture(before, after));
}

/// Reads what was written, draws it, and refuses what is outside the bound.
double checked_error(ar::Fitter& fitter, const ar::FitResult& result, const fs::path& folder,
                     const ar::ErrorBound& bound) {
  // A copy whose paths lead from where it lies to what it names.
  make_folder(folder);
  ar::write_fit_scene(result.given, result.fitted, folder, folder);
  const fs::path scene = folder / kScene;
  const double error = fitter.error_of(ar::load_fit_scene(ar::read_scene(scene)));
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  if (!(error <= bound.value))
    throw ar::InputError(
        fmt::format("{}: as it is read again it has an error of {}, outside the bound",
                    scene.filename().string(), ar::describe_error(bound.unit, error)));
  return error;
}

void fit(const Options& options) {
  const ar::ErrorBound bound = ar::parse_error_bound(options.error);
  const ar::SceneFile scene = ar::read_scene(options.scene);
  const std::vector<fs::path> inputs = inputs_of(options, scene);
  check_folder(options.out);
  for (const fs::path& input : inputs) {
    for (const char* name : kPictures) refuse_to_replace(input, options.out / name);
    for (const char* name : kReports) refuse_to_replace(input, options.out / name);
    refuse_to_replace(input, options.out / kScene);
  }
  std::optional<Progress> progress;
  ar::FitOptions how{.bound = bound,
                     .repeat = options.repeat,
                     .threads = options.threads,
                     .lit_scene = options.lit_scene,
                     .progress = [&](std::size_t done, std::size_t all) {
                       if (!progress) progress.emplace("item", static_cast<std::int64_t>(all));
                       progress->show(static_cast<std::int64_t>(done));
                     }};
  ar::Fitter fitter(scene, read_photographs(options.images), how);
  const ar::FitResult result = search(options, fitter, progress);

  const Staging staging(options.out);
  const double written = checked_error(fitter, result, staging.folder() / "check", bound);
  ar::write_fit_scene(result.given, result.fitted, staging.folder(), options.out);
  write_pictures(fitter, result, staging.folder());
  const FitReport report{options.scene, options.images, bound, &result, written};
  const nlohmann::ordered_json json = fit_json(report);
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  ar::write_file(staging.folder() / kReports[0], json.dump(2, ' ', false, kReplace) + "\n");
  ar::write_file(staging.folder() / kReports[1], fit_text(report));
  for (const fs::path& file : staging.files())
    for (const fs::path& input : inputs) refuse_to_replace(input, options.out / file);
  staging.move_to(options.out);
  if (options.json)
    std::cout << json.dump(-1, ' ', false, kReplace) << '\n';
  else
    std::cout << fit_text(report) << "\nwrote " << (options.out / kScene).string() << '\n';
}

}  // namespace

void add_fit(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "fit", "Find the least that a scene needs within an error, measured on its own pictures");
  command->add_option("scene", options->scene, "Scene file (TOML, docs/scene.md)")->required();
  command
      ->add_option("--error", options->error,
                   "How far the picture may be from the exact scene's: pixels that anything may be "
                   "displaced by (1px), or mean FLIP where shadows and objects are (0.02flip)")
      ->required();
  command->add_option("--out", options->out, "Folder for the results")->required();
  command->add_option("--image", options->images,
                      "Photograph; several are all held to the bound. Without one the scene is "
                      "drawn by itself, as gnomon render does");
  command->add_option("--lit-scene", options->lit_scene,
                      "What gnomon capture wrote, for differential shadows (default: the scene's)");
  command->add_option("--repeat", options->repeat, "Frames that a time is the median of")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
  command->add_flag("--json", options->json, "Print the report as one line of JSON");
  command->footer(
      "Writes scene.toml, which gnomon ar and gnomon render take as it is, with its models/; "
      "report.json and report.md\n"
      "(each item: what it came with, what was taken, what the next less would have brought); "
      "before.png, after.png and\n"
      "difference.png (grey where both agree, four times what is lighter or darker). docs/fit.md "
      "says how it searches.\n"
      "Examples:\n"
      "  gnomon fit examples/desk/01_torus_on_house.toml --image examples/desk/background.png "
      "--error 1px --out out\n"
      "  gnomon fit examples/soft/box.toml --image examples/soft/background.png --lit-scene "
      "room.lit --error 0.02flip --out out\n"
      "  gnomon fit examples/kuehl/both_methods.toml --error 1px --out out --json");
  command->callback([options] { fit(*options); });
}

}  // namespace gnomon::apps
