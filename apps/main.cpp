// The program: parses the command line, runs one subcommand, and is the one place where an error
// becomes a line for a person and an exit status.
#include <algorithm>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include <CLI/CLI.hpp>

#include "apps/commands.h"

namespace {

constexpr int kFailure = 1;

/// Libraries put line breaks into their messages; a message here is one line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

int fail(const std::string& message) {
  std::cout.flush();
  std::cerr << "gnomon: " << one_line(message) << '\n';
  return kFailure;
}

int run(int argc, char** argv) {
  CLI::App program("Shadows for augmented reality, drawn on the CPU into buffers one can read.",
                   "gnomon");
  program.set_version_flag("--version", "gnomon " GNOMON_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Examples:\n"
      "  gnomon ar scene.toml --image photograph.png --out out --steps\n"
      "  gnomon capture examples/soft --out soft.lit\n"
      "  gnomon chart --out out\n"
      "  gnomon compare rendered.png photograph.png --mask region.png\n"
      "  gnomon fit scene.toml --image photograph.png --error 1px --out out\n"
      "  gnomon history recorded.frame 320 240\n"
      "  gnomon inspect scene.toml --image photograph.png --out page.html\n"
      "  gnomon lab --page lab.html\n"
      "  gnomon mesh check model.glb\n"
      "  gnomon render scene.toml --out out\n"
      "  gnomon replay recorded.frame --out out\n"
      "  gnomon stability --out out\n"
      "  gnomon golden --verify\n"
      "  gnomon COMMAND --help");
  gnomon::apps::add_ar(program);
  gnomon::apps::add_capture(program);
  gnomon::apps::add_chart(program);
  gnomon::apps::add_compare(program);
  gnomon::apps::add_fit(program);
  gnomon::apps::add_golden(program);
  gnomon::apps::add_history(program);
  gnomon::apps::add_inspect(program);
  gnomon::apps::add_lab(program);
  gnomon::apps::add_mesh(program);
  gnomon::apps::add_render(program);
  gnomon::apps::add_replay(program);
  gnomon::apps::add_stability(program);

  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    program.exit(help_or_version);
  } catch (const CLI::ParseError& misuse) {
    const auto commands = program.get_subcommands({});
    const bool unknown = argc > 1 && argv[1][0] != '-' &&
                         std::none_of(commands.begin(), commands.end(),
                                      [&](const CLI::App* c) { return c->get_name() == argv[1]; });
    fail(unknown ? std::string("there is no command '") + argv[1] + "'" : misuse.what());
    std::cerr << "Run gnomon --help, or gnomon COMMAND --help, for the usage.\n";
    return kFailure;
  }
  std::cout.flush();
  return std::cout ? 0 : fail("standard output: cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return fail("out of memory");
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
