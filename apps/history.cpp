// gnomon history: what happened at one pixel of a recorded frame.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/inspector/frame_json.h"
#include "apps/inspector/mesh_parts.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/frame_file.h"
#include "raster/history.h"
#include "raster/state_names.h"
#include "raster/stencil_text.h"

namespace gnomon::apps {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path frame;
  int x = 0, y = 0, around = 0, threads = 0;
  /// Counted from 1, as it is printed; 0: the last.
  std::size_t pass = 0;
  std::size_t commands = std::numeric_limits<std::size_t>::max();
  bool json = false;
};

std::string color_text(const raster::ColorBuffer& target, const glm::vec4& c) {
  if (target.format() == raster::ColorFormat::rgba32f)
    return fmt::format("({} {} {} {})", c.r, c.g, c.b, c.a);
  const auto byte = [](float v) { return std::lround(v * 255.0f); };
  return fmt::format("({} {} {} {})", byte(c.r), byte(c.g), byte(c.b), byte(c.a));
}

std::string change_text(const raster::Targets& targets, const raster::PixelValues& before,
                        const raster::PixelValues& after) {
  std::string out;
  if (targets.stencil && before.stencil != after.stencil)
    out += fmt::format("  stencil {} -> {}", before.stencil, after.stencil);
  if (targets.depth && before.depth != after.depth)
    out += fmt::format("  depth {} -> {}", before.depth, after.depth);
  if (targets.color && before.color != after.color)
    out += fmt::format("  colour {} -> {}", color_text(*targets.color, before.color),
                       color_text(*targets.color, after.color));
  return out.empty() ? "  nothing changes" : out;
}

void print_fragment(const raster::Draw& draw, const raster::Targets& targets,
                    const raster::FragmentRecord& fragment) {
  const std::string_view part = inspector::part_of(draw, fragment.triangle);
  std::string text = fmt::format(
      "         triangle {}{}, {} face", fragment.triangle,
      part.empty() ? std::string() : fmt::format(" ({})", ar::one_line(std::string(part))),
      fragment.front_facing ? "front" : "back");
  if (targets.depth && draw.state.depth)
    text += fmt::format(", depth {} {} {}", fragment.depth, raster::name(draw.state.depth->func),
                        fragment.before.depth);
  text += fmt::format(": {}", raster::name(fragment.outcome));
  if (fragment.stencil_op != raster::StencilOp::keep)
    text += fmt::format(", {}", raster::name(fragment.stencil_op));
  std::cout << text << ';' << change_text(targets, fragment.before, fragment.after) << '\n';
}

void print_text(const raster::Frame& frame, const raster::PixelHistory& told) {
  std::size_t pass = std::numeric_limits<std::size_t>::max();
  for (const raster::CommandRecord& record : told.commands) {
    const raster::Targets& targets = frame.passes()[record.pass].targets;
    if (record.pass != pass) {
      pass = record.pass;
      std::cout << fmt::format("pass {} {}\n", pass + 1, ar::one_line(frame.passes()[pass].label));
    }
    const raster::Command& command = *inspector::place_of(frame, record.command).command;
    std::cout << fmt::format("{:6} {:5} {}{}\n", record.command + 1, raster::kind(command),
                             ar::one_line(std::string(raster::label(command))),
                             change_text(targets, record.before, record.after));
    const auto* draw = std::get_if<raster::Draw>(&command);
    for (const raster::FragmentRecord& fragment : record.fragments)
      print_fragment(*draw, targets, fragment);
  }
  if (told.commands.empty()) std::cout << "no command touched this pixel\n";
}

void print_around(const raster::Targets& targets, const Options& options) {
  const raster::PixelBox box{std::max(options.x - options.around, 0),
                             std::max(options.y - options.around, 0),
                             std::min(options.x + options.around + 1, targets.width()),
                             std::min(options.y + options.around + 1, targets.height())};
  std::cout << fmt::format(
      "\nstencil, x {} to {}, y {} to {} from the bottom row (. is 0, a is 10, A is 255, B is "
      "254):\n{}",
      box.x0, box.x1 - 1, box.y0, box.y1 - 1, raster::stencil_text(*targets.stencil, box));
}

void history(const Options& options) {
  if (options.around > 0 && options.json) throw ar::InputError("--around: not with --json");
  const raster::RecordedFrame recorded = ar::read_frame(options.frame);
  const auto& passes = recorded.frame.passes();
  if (passes.empty()) throw ar::InputError(options.frame.string() + ": the frame has no pass");
  if (options.pass > passes.size())
    throw ar::InputError(
        fmt::format("--pass {}: the frame has {} passes", options.pass, passes.size()));
  const std::size_t pass = options.pass > 0 ? options.pass - 1 : passes.size() - 1;
  const raster::Targets& targets = passes[pass].targets;
  if (options.x >= targets.width() || options.y >= targets.height())
    throw ar::InputError(fmt::format("pixel {} {}: the buffers of pass {} have {}x{} pixels",
                                     options.x, options.y, pass + 1, targets.width(),
                                     targets.height()));
  if (options.around > 0 && !targets.stencil)
    throw ar::InputError(fmt::format("--around: pass {} has no stencil buffer", pass + 1));
  const raster::PixelHistory told =
      raster::history(recorded.frame, options.x, options.y,
                      {.pass = pass, .commands = options.commands, .threads = options.threads});
  if (options.json) {
    // A label is bytes; those that are no UTF-8 are replaced.
    std::cout << inspector::history_json(recorded.frame, told)
                     .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
    return;
  }
  print_text(recorded.frame, told);
  if (options.around > 0) print_around(targets, options);
}

}  // namespace

void add_history(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "history", "Tell of one pixel of a recorded frame: every fragment and what became of it");
  command->add_option("frame", options->frame, "Frame file (docs/frame-format.md)")->required();
  command->add_option("x", options->x, "Column, 0 at the left")
      ->required()
      ->check(CLI::Range(0, raster::kMaxTargetSize - 1));
  command->add_option("y", options->y, "Row, 0 at the bottom as in OpenGL")
      ->required()
      ->check(CLI::Range(0, raster::kMaxTargetSize - 1));
  command
      ->add_option("--pass", options->pass,
                   "The pass whose buffers are meant, from 1 (default: the last)")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--commands", options->commands, "Stop after so many commands")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{1} << 32));
  command
      ->add_option("--around", options->around,
                   "Also print the stencil counts as text, so many pixels to each side")
      ->check(CLI::Range(1, 500));
  command->add_option("--threads", options->threads, "Threads (0: all of the machine)")
      ->check(CLI::Range(0, 256));
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->footer(
      "Frames are written by gnomon ar and gnomon render with --save-frame, and by the lab. "
      "Passes\n"
      "that share a buffer with the one that is meant are part of the history; a shadow map's are "
      "not.\n"
      "\n"
      "Examples:\n"
      "  gnomon history golden/frames/desk-01-zpass.frame 80 60\n"
      "  gnomon history golden/frames/desk-01-zfail.frame 80 60 --commands 29 --around 20\n"
      "  gnomon history my.frame 320 240 --json");
  command->callback([options] { history(*options); });
}

}  // namespace gnomon::apps
