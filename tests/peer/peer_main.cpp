// The peer suite as a program: seeded cases on gnomon and on Mesa, a table a kind, and for a
// failure its seed and the smallest case that still fails. GALLIUM_DRIVER=softpipe chooses Mesa's
// other driver, whose counts are for information.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "describe.h"
#include "raster/frame_format.h"
#include "replay_file.h"
#include "shrink.h"
#include "suite.h"

namespace {

namespace fs = std::filesystem;
using namespace gnomon;
using namespace gnomon::peer;

struct Options {
  std::vector<Kind> kinds{Kind::grid, Kind::free, Kind::lookup};
  std::uint32_t frames = 100, seed = 0;
  /// Failing seeds that are made small, a kind; of llvmpipe three if absent, of softpipe none.
  std::optional<std::size_t> shrunk;
  bool json = false;
  fs::path save, replay;
};

std::vector<std::uint8_t> read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  return bytes;
}

void save(const fs::path& path, const Case& failing) {
  const std::vector<std::uint8_t> bytes = raster::encode_frame(Recording(failing).frame());
  fs::create_directories(path.parent_path());
  const fs::path beside = path.string() + ".part";
  std::ofstream file(beside, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::runtime_error(beside.string() + ": cannot be written");
  fs::rename(beside, path);
}

std::optional<Disagreement> failure(const OsmesaContext& context, Kind kind, const Case& tried) {
  Tally unused;
  return run_case(context, kind, tried, unused);
}

/// Prints seed, smallest case, pixel and both values.
void report_failure(const OsmesaContext& context, Kind kind, std::uint32_t seed,
                    const Options& options) {
  const Case smallest = shrink(make_case(kind, seed), [&](const Case& smaller) {
    return failure(context, kind, smaller).has_value();
  });
  const Disagreement found = failure(context, kind, smallest).value();
  std::ostream& out = options.json ? std::cerr : std::cout;
  out << name(kind) << " seed " << seed << " fails; its smallest case, " << smallest.triangles()
      << " triangles:\n"
      << describe(smallest) << "after command " << found.commands << ", pixel (" << found.x << ", "
      << found.y << "): " << found.values << "\n";
  if (options.save.empty()) return;
  const fs::path path =
      options.save / (std::string(name(kind)) + "_" + std::to_string(seed) + ".frame");
  save(path, smallest);
  out << "saved as " << path.string() << "\n";
}

/// False if a case fails that must not.
bool run_kind(const OsmesaContext& context, Kind kind, const Options& options) {
  Tally tally;
  std::vector<std::uint32_t> failing;
  for (std::uint32_t i = 0; i < options.frames; ++i) {
    const std::uint32_t seed = options.seed + i;
    if (run_case(context, kind, make_case(kind, seed), tally)) failing.push_back(seed);
  }
  std::cout << (options.json ? json(kind, tally, context.renderer()) : table(kind, tally));
  const std::size_t shrunk = options.shrunk.value_or(context.is_llvmpipe() ? 3 : 0);
  for (std::size_t i = 0; i < std::min(failing.size(), shrunk); ++i)
    report_failure(context, kind, failing[i], options);
  return failing.empty() || !context.is_llvmpipe();
}

int run(const Options& options) {
  if (!options.replay.empty()) {
    const FrameReplay replayed = replay_frame(raster::decode_frame(read_bytes(options.replay)));
    std::cout << replayed.text;
    return replayed.is_llvmpipe && replayed.unexplained > 0 ? 1 : 0;
  }
  const OsmesaContext context(kCaseSize, kCaseSize);
  if (!options.json)
    std::cout << context.renderer() << ", " << context.version()
              << (context.is_llvmpipe() ? "\n"
                                        : "; the counts of this driver are for information\n");
  bool good = true;
  for (const Kind kind : options.kinds) good = run_kind(context, kind, options) && good;
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Random cases on gnomon and on Mesa's OpenGL, compared byte by byte.",
                   "peer_suite");
  Options options;
  const std::map<std::string, Kind> kinds{
      {"grid", Kind::grid}, {"free", Kind::free}, {"lookup", Kind::lookup}};
  program.add_option("--kind", options.kinds, "grid, free, lookup; all of them if left out")
      ->option_text("KIND ...")
      ->transform(CLI::CheckedTransformer(kinds));
  program.add_option("--frames", options.frames, "cases a kind (grid: 200 draws each)")
      ->capture_default_str();
  program.add_option("--seed", options.seed, "of the first case")->capture_default_str();
  program.add_option("--shrink", options.shrunk,
                     "failing cases to make small, a kind (3; softpipe: 0)");
  program.add_flag("--json", options.json, "a line of JSON a kind instead of tables");
  program.add_option("--save", options.save, "folder for the smallest failing frames");
  program.add_option("--replay", options.replay, "replay a saved frame, pass by pass")
      ->check(CLI::ExistingFile);
  program.footer(
      "Mesa's driver is llvmpipe, or softpipe with GALLIUM_DRIVER=softpipe.\n"
      "Exit status 1: a case failed on llvmpipe, or something went wrong.");
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& end) {
    return program.exit(end) == 0 ? 0 : 1;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::cerr << "peer_suite: " << error.what() << "\n";
    return 1;
  }
}
