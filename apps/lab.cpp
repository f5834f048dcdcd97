// gnomon lab: the page to play with, and the pictures and hashes of states that were saved there.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/inspector/inspection.h"
#include "apps/inspector/lab_frame.h"
#include "apps/inspector/lab_state.h"
#include "apps/inspector/page.h"
#include "apps/output_folder.h"
#include "apps/page_output.h"
#include "ar/buffer_picture.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/frame_file.h"
#include "ar/image_file.h"
#include "golden/hash.h"
#include "raster/frame_format.h"

namespace gnomon::apps {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path state, page, out, save_frame;
};

constexpr std::uint64_t kMaxStateBytes = 65536;

inspector::LabState read_state(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = ar::read_file(path, kMaxStateBytes);
  try {
    return inspector::read_lab_state(std::string(bytes.begin(), bytes.end()));
  } catch (const inspector::LabError& error) {
    throw ar::InputError(path.string() + ": " + ar::one_line(error.what()));
  }
}

void draw(const Options& options) {
  if (!options.out.empty()) check_folder(options.out);
  check_frame_target(options.save_frame, {options.state});
  const auto lab = inspector::record_lab(read_state(options.state));
  inspector::Inspection inspection(lab, lab->frame);
  inspection.seek(lab->frame.command_count());
  const std::vector<raster::Buffer> buffers = inspection.buffers().save();
  if (!options.out.empty()) {
    make_folder(options.out);
    for (std::size_t i = 0; i < buffers.size(); ++i)
      ar::write_png(options.out / fmt::format("{:02}_{}.png", i, golden::hash_of(buffers[i]).kind),
                    ar::buffer_picture(buffers[i]));
  }
  if (!options.save_frame.empty())
    ar::write_frame(options.save_frame, raster::encode_frame(lab->frame));
  for (const raster::Buffer& buffer : buffers)
    std::cout << golden::sentence(golden::hash_of(buffer)) << '\n';
}

void lab(const Options& options) {
  if (options.page.empty() == options.state.empty())
    throw ar::InputError("lab: either a state or --page is needed");
  if (options.page.empty()) return draw(options);
  if (!options.out.empty() || !options.save_frame.empty())
    throw ar::InputError("lab: --out and --save-frame go with a state");
  check_page_folder(options.page);
  write_page(options.page, inspector::lab_page());
}

}  // namespace

void add_lab(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "lab",
      "Make the page where one moves light, camera and objects, or draw a state saved there");
  command->add_option("state", options->state, "State that was saved on the page (JSON)");
  command->add_option("--page", options->page, "Write the page here, such as lab.html");
  command->add_option("--out", options->out, "Folder for a picture of every buffer of the state");
  command->add_option("--save-frame", options->save_frame,
                      "Also write the state's frame here, for gnomon history and gnomon inspect");
  command->footer(
      "Prints the hash of every buffer of a state: those that the page shows. ./dev lab makes the\n"
      "page and serves it on this machine's own address; it also opens from disk.\n"
      "\n"
      "Examples:\n"
      "  gnomon lab --page lab.html\n"
      "  gnomon lab state.json --out out --save-frame lab.frame");
  command->callback([options] { lab(*options); });
}

}  // namespace gnomon::apps
