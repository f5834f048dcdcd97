#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "apps/output_folder.h"
#include "apps/progress.h"
#include "apps/shard_arguments.h"
#include "apps/study/generated_sweeps.h"
#include "apps/study/photograph_sweeps.h"
#include "apps/study/stability.h"
#include "ar/error.h"

namespace gnomon::apps {

namespace fs = std::filesystem;

namespace {

struct Options {
  fs::path out, examples = GNOMON_SOURCE_DIR "/examples";
  std::vector<std::string> only;
  bool list = false;
  ShardArguments run;
};

study::Sweeps every_sweep(const Options& options) {
  study::Sweeps sweeps = study::generated_sweeps(options.run.threads);
  if (study::has_photographs(options.examples))
    study::add_photograph_sweeps(sweeps, options.examples, options.run.threads);
  else
    std::cerr << fmt::format(
        "gnomon: note: --examples {}: no desk/ and soft/ with photographs, so "
        "sweeps that need them are left out\n",
        options.examples.string());
  return sweeps;
}

study::Sweeps chosen_sweeps(const Options& options) {
  study::Sweeps all = every_sweep(options);
  if (options.only.empty()) return all;
  for (const std::string& name : options.only)
    if (std::ranges::none_of(all, [&](const auto& s) { return s->text().name == name; }))
      throw ar::InputError(fmt::format(
          "--only {}: there is no such sweep here (--list names them; those of photographs "
          "need --examples)",
          name));
  std::erase_if(all, [&](const auto& sweep) {
    return std::ranges::find(options.only, sweep->text().name) == options.only.end();
  });
  return all;
}

void list(const study::Sweeps& sweeps) {
  for (const auto& sweep : sweeps) {
    const study::SweepText text = sweep->text();
    std::cout << fmt::format("{:24} {} ({}; {} inputs)\n", text.name, text.title, text.parameter,
                             sweep->inputs() * sweep->values().size());
  }
}

void say_written(const fs::path& out, const study::StabilityPart& whole) {
  std::cout << fmt::format("{} sweeps, {} inputs; wrote {}\n", whole.sweeps.size(),
                           study::inputs_of(whole), (out / "stability.html").string());
}

void stability(const Options& options) {
  const study::Shard shard = study::parse_shard("--shard", options.run.shard);
  if (options.list) return list(every_sweep(options));
  if (options.out.empty()) throw ar::InputError("--out: missing: where do the results go?");
  check_folder(options.out);
  if (options.run.merge) return say_written(options.out, study::merge_stability(options.out));
  const study::Sweeps sweeps = chosen_sweeps(options);
  study::StabilityPart part;
  {
    const Progress progress("value",
                            static_cast<std::int64_t>(shard.share_of(study::jobs_of(sweeps))));
    part = study::run_stability(sweeps, shard, options.out, [&](std::size_t done) {
      progress.show(static_cast<std::int64_t>(done));
    });
  }
  if (!shard.is_whole()) {
    std::cout << fmt::format("part {} of {}: {} values of {}\n", shard.number, shard.count,
                             part.columns.size(), part.jobs);
    return;
  }
  study::write_stability(options.out, part);
  say_written(options.out, part);
}

}  // namespace

void add_stability(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
      "stability", "Sweep each way in which shadow methods fail, and map where they give up");
  command->add_option("--out", options->out, "Folder for the results");
  command->add_option("--only", options->only, "These sweeps alone (--list names them)");
  command->add_option("--examples", options->examples,
                      "Folder with desk/ and soft/, whose photographs some sweeps need");
  command->add_flag("--list", options->list, "Name the sweeps, and do nothing else");
  add_shard(*command, options->run);
  command->footer(
      "Writes stability.html (one file, no network needed), stability.csv and stability.json; the\n"
      "same bytes for every number of threads.\n"
      "Examples:\n"
      "  gnomon stability --list\n"
      "  gnomon stability --out out --only camera-in-volume\n"
      "  gnomon stability --out out --shard 2/8  # on each of eight machines, then\n"
      "  gnomon stability --out out --merge");
  command->callback([options] { stability(*options); });
}

}  // namespace gnomon::apps
