// gnomon golden: do the golden frames have their bytes on this machine?
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/progress.h"
#include "apps/variant.h"
#include "ar/error.h"
#include "golden/manifest.h"
#include "golden/variants.h"

namespace gnomon::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Options {
  fs::path folder;
  VariantArguments variant;
  bool verify = false, all_variants = false, json = false;
};

/// A run whose buffers are not the manifest's.
struct Differing {
  std::string variant;
  /// Those buffers, as they should be and as they are.
  std::vector<std::string> buffers;
};

struct Result {
  std::string scene;
  std::size_t runs = 0;
  std::vector<Differing> differing;
  /// Why the frame could not be run at all.
  std::string error;
  bool good() const { return differing.empty() && error.empty(); }
};

/// Beside the program where it is installed, else where it was built from.
fs::path default_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path() / GNOMON_GOLDEN_FROM_PROGRAM;
  if (!error && fs::exists(golden::manifest_path(installed), error))
    return installed.lexically_normal();
  return GNOMON_SOURCE_DIR "/golden";
}

std::string name_of(const raster::ExecuteOptions& variant) {
  return variant.threads > 0
             ? variants::name(variant)
             : fmt::format("{} on all threads", std::string(raster::name(variant.isa)));
}

Differing compare(const golden::Entry& entry, const std::vector<golden::BufferHash>& got,
                  const raster::ExecuteOptions& variant) {
  Differing out{name_of(variant), {}};
  if (got.size() != entry.buffers.size())
    out.buffers.push_back(
        fmt::format("{} buffers instead of {}", got.size(), entry.buffers.size()));
  for (std::size_t i = 0; i < std::min(got.size(), entry.buffers.size()); ++i)
    if (got[i] != entry.buffers[i])
      out.buffers.push_back(golden::sentence(got[i]) + " instead of " +
                            golden::sentence(entry.buffers[i]));
  return out;
}

Result verify(const fs::path& folder, const std::string& scene, const golden::Entry& entry,
              const std::vector<raster::ExecuteOptions>& chosen, Progress& progress,
              std::size_t& done) {
  Result result{.scene = scene};
  try {
    const std::vector<std::uint8_t> bytes = golden::read_frame_bytes(folder, entry.frame);
    for (const raster::ExecuteOptions& variant : chosen) {
      const auto got = golden::hashes_of(golden::replay(bytes, entry.commands, variant));
      ++result.runs;
      progress.show(static_cast<std::int64_t>(++done));
      Differing differing = compare(entry, got, variant);
      if (!differing.buffers.empty()) result.differing.push_back(std::move(differing));
    }
  } catch (const golden::FolderError& error) {
    result.error = error.what();
  } catch (const raster::FormatError& error) {
    result.error = golden::frame_path(folder, entry.frame).string() + ": " + error.what();
  }
  return result;
}

void print_text(const Result& result) {
  if (!result.error.empty()) {
    std::cout << fmt::format("{:28} cannot be run: {}\n", result.scene, result.error);
    return;
  }
  if (result.good()) {
    std::cout << fmt::format("{:28} ok\n", result.scene);
    return;
  }
  std::cout << fmt::format("{:28} differs in {} of {} runs\n", result.scene,
                           result.differing.size(), result.runs);
  for (const Differing& d : result.differing)
    for (const std::string& buffer : d.buffers)
      std::cout << fmt::format("  {}: {}\n", d.variant, buffer);
}

ordered_json to_json(const Result& result) {
  ordered_json differing = ordered_json::array();
  for (const Differing& d : result.differing)
    differing.push_back({{"variant", d.variant}, {"buffers", d.buffers}});
  ordered_json out{{"name", result.scene}, {"runs", result.runs}, {"differing", differing}};
  if (!result.error.empty()) out["error"] = result.error;
  return out;
}

void run(const Options& options) {
  if (!options.verify) throw ar::InputError("golden: --verify says what to do");
  const fs::path folder = options.folder.empty() ? default_folder() : options.folder;
  const std::vector<raster::ExecuteOptions> chosen =
      options.all_variants ? variants::every_variant()
                           : std::vector{execute_options(options.variant)};
  const golden::Manifest manifest = golden::read_manifest(folder);
  std::size_t runs = 0, differing = 0, unusable = 0, done = 0;
  ordered_json scenes = ordered_json::array();
  {
    Progress progress("run", static_cast<std::int64_t>(manifest.size() * chosen.size()));
    for (const auto& [name, entry] : manifest) {
      const Result result = verify(folder, name, entry, chosen, progress, done);
      runs += result.runs;
      differing += result.differing.size();
      unusable += !result.error.empty();
      if (options.json)
        scenes.push_back(to_json(result));
      else
        print_text(result);
    }
  }
  if (options.json)
    std::cout << ordered_json{{"folder", folder.string()}, {"scenes", scenes},
                              {"variants", chosen.size()}, {"runs", runs},
                              {"differing", differing},    {"unusable", unusable}}
                     .dump(-1, ' ', false, ordered_json::error_handler_t::replace)
              << '\n';
  const std::string summary = fmt::format("{} scenes, {} variants, {} runs, {} differing",
                                          manifest.size(), chosen.size(), runs, differing);
  if (!options.json) std::cout << summary << '\n';
  if (differing > 0 || unusable > 0)
    throw ar::InputError(fmt::format("{}: {} of {} runs differ, {} frames cannot be run",
                                     folder.string(), differing, runs, unusable));
}

}  // namespace

void add_golden(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "golden", "Check that this machine draws the golden frames to the byte");
  command->add_flag("--verify", options->verify,
                    "Execute every golden frame and compare hashes; status 1 if one differs");
  CLI::Option* all = command->add_flag(
      "--all-variants", options->all_variants,
      "On every instruction set of this machine, each on 1, 2, 3, 7 and 16 threads");
  command->add_option("--golden", options->folder,
                      "Folder with manifest.json and frames (default: the installed one, else the "
                      "source's)");
  add_variant(*command, options->variant);
  for (const char* one : {"--isa", "--threads"}) all->excludes(command->get_option(one));
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->footer(
      "Examples:\n"
      "  gnomon golden --verify\n"
      "  gnomon golden --verify --isa scalar --threads 1\n"
      "  gnomon golden --verify --all-variants --json");
  command->callback([options] { run(*options); });
}

}  // namespace gnomon::apps
