// The program: parses the command line, and is the one place where an error becomes a line for a
// person and an exit status.
#include <csignal>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ar/file.h"
#include "bench/goals.h"
#include "bench/growth.h"
#include "bench/measure.h"
#include "bench/plot.h"
#include "bench/worker.h"

namespace gnomon::bench {
namespace {

struct Arguments {
  Options options;
  std::vector<std::string> sizes, systems;
  GrowthOptions growth;
  std::string json, markdown, svg;
  bool quick = false, list = false;
  /// Of the hidden subcommand that is one worker.
  std::string subject, size, system, method;
  int worker_threads = 1;
};

void add_run(CLI::App& program, Arguments& arguments) {
  Options& options = arguments.options;
  program.add_option("--scene", options.scenes, "Scenes to measure (--list); all without it")
      ->type_name("NAME");
  program.add_option("--size", arguments.sizes, "Sizes in pixels; each scene's own without it")
      ->type_name("WIDTHxHEIGHT");
  program.add_option("--threads", options.threads, "Numbers of threads (1 2)")
      ->type_name("N")
      ->check(CLI::Range(1, 256));
  program
      .add_option("--system", arguments.systems,
                  "gnomon, llvmpipe, softpipe, embree; all without it")
      ->type_name("NAME");
  program.add_option("--frames", options.turns.frames, "Frames that a median is taken of (20)")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  program
      .add_option("--cap", options.turns.cap_s,
                  "Seconds after which one system's frames of one scene are enough (20)")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.0, 1e6));
  program.add_option("--mesh", options.models, "glTF models to add to the scene 'meshes'")
      ->type_name("FILE");
  program.add_option("--json", arguments.json, "Write every row to this file")->type_name("FILE");
  program.add_option("--markdown", arguments.markdown, "Write the table of docs/performance.md")
      ->type_name("FILE");
  program.add_flag("--quick", arguments.quick,
                   "Small pictures and few frames: do all systems agree?");
  program.add_flag("--list", arguments.list, "Name the scenes and stop");
}

CLI::App* add_growth(CLI::App& program, Arguments& arguments) {
  CLI::App* growth =
      program.add_subcommand("growth", "Time and memory against triangles and against pixels");
  GrowthOptions& options = arguments.growth;
  growth->add_option("--threads", options.threads, "Number of threads (2)")
      ->type_name("N")
      ->check(CLI::Range(1, 256));
  growth->add_option("--rounds", options.rounds, "How often all steps are gone through (3)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  growth->add_option("--frames", options.turns.frames, "Frames of a step in a round (3)")
      ->type_name("N")
      ->check(CLI::Range(1, 100000));
  growth->add_option("--most-triangles", options.most_triangles, "Leave out what has more")
      ->type_name("N");
  growth->add_option("--most-pixels", options.most_pixels, "Leave out what has more")
      ->type_name("N");
  growth->add_option("--json", arguments.json, "Write every point to this file")->type_name("FILE");
  growth->add_option("--svg", arguments.svg, "Draw the curves into this file")->type_name("FILE");
  growth->footer("Example:\n  gnomon_bench growth --svg growth.svg --most-triangles 1000000");
  return growth;
}

CLI::App* add_worker(CLI::App& program, Arguments& arguments) {
  CLI::App* worker =
      program.add_subcommand("worker", "One system that answers on its standard input");
  worker->group("");
  worker->add_option("subject", arguments.subject)->required();
  worker->add_option("size", arguments.size)->required();
  worker->add_option("system", arguments.system)->required();
  worker->add_option("method", arguments.method)->required();
  worker->add_option("threads", arguments.worker_threads)->required();
  worker->add_option("--mesh", arguments.options.models);
  return worker;
}

void list_subjects() {
  const auto line = [](const std::string& name, const std::string& what) {
    fmt::print("{:<14} {}\n", name, what);
  };
  for (const UsualSubject& subject : usual_subjects()) {
    std::string sizes;
    for (const Size size : subject.sizes) sizes += " " + text(size);
    line(subject.name, std::string(subject.what) + ":" + sizes);
  }
  line("tori-N", "N tori, 1 to 4096");
  line("grid-T", "twelve tori of about T triangles together");
  line("depth-N", "N tori, depth only");
}

int run(Arguments& arguments) {
  Options& options = arguments.options;
  for (const std::string& size : arguments.sizes) options.sizes.push_back(size_from(size));
  if (!arguments.systems.empty()) options.systems.clear();
  for (const std::string& system : arguments.systems) {
    options.systems.push_back(system_named(system));
  }
  if (arguments.quick) {
    options.turns.frames = 2;
    if (options.sizes.empty()) options.sizes = {{160, 120}};
  }
  const Report report = measure(options);
  std::cout << table(report.rows) << '\n' << text(goals(report.rows)) << std::flush;
  if (!arguments.json.empty()) ar::write_file(arguments.json, to_json(report).dump(1) + "\n");
  if (!arguments.markdown.empty()) ar::write_file(arguments.markdown, markdown(report));
  return std::cout ? 0 : 1;
}

int run_growth(const Arguments& arguments) {
  const Report now = report_of_now();
  const Growth growth = measure_growth(arguments.growth);
  std::cout << table(growth) << std::flush;
  if (!arguments.json.empty()) ar::write_file(arguments.json, to_json(growth, now).dump(1) + "\n");
  if (!arguments.svg.empty()) ar::write_file(arguments.svg, plot_svg(growth));
  return std::cout ? 0 : 1;
}

int start(int argc, char** argv) {
  CLI::App program("gnomon, Mesa's software drivers and Embree in turn on the same scenes.",
                   "gnomon_bench");
  program.footer(
      "Examples:\n"
      "  gnomon_bench                                     everything, which takes a while\n"
      "  gnomon_bench --scene tori-12 --size 640x480      one scene at one size\n"
      "  gnomon_bench --scene tori-12 --scene tori-64 --json bench.json\n"
      "  gnomon_bench growth --svg growth.svg             time against triangles and pixels\n"
      "  gnomon_bench --quick                             checks pictures, measures little\n"
      "What stages and methods mean: docs/performance.md");
  Arguments arguments;
  add_run(program, arguments);
  const CLI::App* growth = add_growth(program, arguments);
  const CLI::App* worker = add_worker(program, arguments);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& misuse) {
    std::cerr << "gnomon_bench: " << misuse.what() << "\nRun gnomon_bench --help for the usage.\n";
    return 1;
  }
  if (worker->parsed()) {
    return serve(
        arguments.subject, size_from(arguments.size), arguments.options.models,
        {system_named(arguments.system), method_named(arguments.method), arguments.worker_threads});
  }
  if (growth->parsed()) return run_growth(arguments);
  if (arguments.list) {
    list_subjects();
    return 0;
  }
  return run(arguments);
}

}  // namespace
}  // namespace gnomon::bench

int main(int argc, char** argv) {
  // A worker that ended is reported by what it does not answer.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return gnomon::bench::start(argc, argv);
  } catch (const std::exception& error) {
    std::cout.flush();
    std::cerr << "gnomon_bench: " << error.what() << '\n';
    return 1;
  }
}
