#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/output_folder.h"
#include "apps/progress.h"
#include "apps/shard_arguments.h"
#include "apps/study/chart.h"
#include "apps/study/chart_cases.h"
#include "apps/study/gnuplot.h"
#include "ar/error.h"

namespace gnomon::apps {

namespace fs = std::filesystem;

namespace {

struct Options {
  std::vector<fs::path> studies;
  fs::path out;
  bool generated = true;
  int frames = 11;
  ShardArguments run;
};

void say_written(const fs::path& out, const study::ChartPart& whole) {
  std::cout << fmt::format("{} points; wrote {}\n", whole.points.size(),
                           (out / "chart.html").string());
}

void chart(const Options& options) {
  const study::Shard shard = study::parse_shard("--shard", options.run.shard);
  check_folder(options.out);
  if (options.run.merge || shard.is_whole()) study::require_gnuplot();
  if (options.run.merge) return say_written(options.out, study::merge_chart(options.out));
  study::CapturedRooms rooms(options.run.threads);
  study::ChartCases cases =
      study::chart_cases(options.studies, options.generated, rooms, options.run.threads);
  if (cases.empty())
    throw ar::InputError("chart: there is nothing to chart: name a study or a scene file");
  study::ChartPart part;
  {
    const auto jobs = shard.share_of(cases.size());
    const Progress progress("scene", static_cast<std::int64_t>(jobs));
    part =
        study::run_chart(std::move(cases), shard, options.frames, options.out,
                         [&](std::size_t done) { progress.show(static_cast<std::int64_t>(done)); });
  }
  if (!shard.is_whole()) {
    std::cout << fmt::format("part {} of {}: {} of {} scenes, {} points\n", shard.number,
                             shard.count, part.done.size(), part.jobs, part.points.size());
    return;
  }
  study::write_chart(options.out, part);
  say_written(options.out, part);
}

}  // namespace

void add_chart(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "chart", "Chart time against error: every shadow method and setting on every scene");
  command->add_option("study", options->studies,
                      "Study files, which name photographs with their truth, and scene files "
                      "(TOML, docs/accuracy.md)");
  command->add_flag("!--no-generated", options->generated,
                    "Leave out the scenes that the program makes itself");
  command->add_option("--out", options->out, "Folder for the results")->required();
  command
      ->add_option("--frames", options->frames, "Frames a setting that are timed (0: errors only)")
      ->check(CLI::Range(0, 10'000))
      ->capture_default_str();
  add_shard(*command, options->run);
  command->footer(
      "Writes chart.html (one file, no network needed), chart.csv, chart.json, pictures/ and, "
      "where\n"
      "something was timed, chart.svg. --merge takes the parts as they are, whatever else is "
      "given.\n"
      "Examples:\n"
      "  gnomon chart --out out\n"
      "  gnomon chart examples/study.toml --out out\n"
      "  gnomon chart --out out --shard 2/8      # on each of eight machines, then\n"
      "  gnomon chart --out out --merge");
  command->callback([options] { chart(*options); });
}

}  // namespace gnomon::apps
