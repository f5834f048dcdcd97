// gnomon replay: a recorded frame executed anew, with the hash of every buffer that it leaves.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/output_folder.h"
#include "apps/variant.h"
#include "ar/buffer_picture.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/frame_file.h"
#include "ar/image_file.h"
#include "golden/hash.h"
#include "raster/state_names.h"

namespace gnomon::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct Options {
  fs::path frame, out;
  VariantArguments variant;
  std::size_t commands = std::numeric_limits<std::size_t>::max();
  bool json = false;
};

std::string label_of(const raster::Command& command) {
  return ar::one_line(raster::label(command));
}

void write_pictures(const fs::path& out, const raster::RecordedFrame& recorded,
                    const std::vector<golden::BufferHash>& hashes) {
  make_folder(out);
  for (std::size_t i = 0; i < hashes.size(); ++i)
    ar::write_png(out / fmt::format("{:02}_{}.png", i, hashes[i].kind),
                  ar::buffer_picture(recorded.buffers[i]));
}

void print_json(const Options& options, const raster::Frame& frame, std::size_t executed,
                const std::vector<golden::BufferHash>& hashes) {
  ordered_json passes = ordered_json::array(), buffers = ordered_json::array();
  for (const raster::Pass& pass : frame.passes()) {
    ordered_json commands = ordered_json::array();
    for (const raster::Command& command : pass.commands)
      commands.push_back({{"kind", raster::kind(command)}, {"label", label_of(command)}});
    passes.push_back({{"label", pass.label},
                      {"size", {pass.targets.width(), pass.targets.height()}},
                      {"commands", commands}});
  }
  for (const golden::BufferHash& b : hashes)
    buffers.push_back({{"kind", b.kind},
                       {"format", b.format},
                       {"width", b.width},
                       {"height", b.height},
                       {"hash", b.hash}});
  const ordered_json line{{"frame", options.frame.string()},
                          {"executed", executed},
                          {"passes", passes},
                          {"buffers", buffers}};
  // A label is bytes; those that are no UTF-8 are replaced.
  std::cout << line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) << '\n';
}

void print_text(const raster::Frame& frame, std::size_t executed,
                const std::vector<golden::BufferHash>& hashes) {
  std::cout << fmt::format("{} passes, {} commands, {} executed\n", frame.passes().size(),
                           frame.command_count(), executed);
  std::size_t number = 0;
  for (const raster::Pass& pass : frame.passes()) {
    std::cout << fmt::format("pass {}x{} {}\n", pass.targets.width(), pass.targets.height(),
                             ar::one_line(pass.label));
    for (const raster::Command& command : pass.commands) {
      std::cout << fmt::format("{:6} {:5} {}", ++number, raster::kind(command), label_of(command));
      std::cout << (number > executed ? " (left out)\n" : "\n");
    }
  }
  for (std::size_t i = 0; i < hashes.size(); ++i)
    std::cout << fmt::format("buffer {} {}\n", i, golden::sentence(hashes[i]));
}

void replay(const Options& options) {
  raster::ExecuteOptions execute = execute_options(options.variant);
  execute.commands = options.commands;
  if (!options.out.empty()) check_folder(options.out);
  const raster::RecordedFrame recorded = ar::read_frame(options.frame);
  raster::execute(recorded.frame, execute);
  const std::vector<golden::BufferHash> hashes = golden::hashes_of(recorded);
  if (!options.out.empty()) write_pictures(options.out, recorded, hashes);
  const std::size_t executed = std::min(options.commands, recorded.frame.command_count());
  if (options.json)
    print_json(options, recorded.frame, executed, hashes);
  else
    print_text(recorded.frame, executed, hashes);
}

}  // namespace

void add_replay(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "replay", "Execute a recorded frame and print the hash of every buffer");
  command->add_option("frame", options->frame, "Frame file (docs/frame-format.md)")->required();
  add_variant(*command, options->variant);
  command->add_option("--commands", options->commands, "Stop after so many commands")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 32));
  command->add_option("--out", options->out, "Folder for a picture of every buffer");
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->footer(
      "Hashes are FNV-1a of 64 bits over pixels from the bottom row (golden/README.md); the same\n"
      "frame has the same ones whatever the instruction set and the number of threads.\n"
      "Pictures: colour as r, g, b; depth as grey, nearer is lighter; stencil in false colour.\n"
      "\n"
      "Examples:\n"
      "  gnomon replay golden/frames/desk-01-zpass.frame\n"
      "  gnomon replay golden/frames/desk-04-automatic.frame --commands 20 --out out/desk\n"
      "  gnomon replay my.frame --isa scalar --threads 1 --json");
  command->callback([options] { replay(*options); });
}

}  // namespace gnomon::apps
