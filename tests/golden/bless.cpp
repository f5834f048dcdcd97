#include "golden/bless.h"

#include <chrono>
#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "ar/image_file.h"
#include "golden/manifest.h"
#include "golden/pictures.h"
#include "reference/reference.h"

namespace gnomon::golden {
namespace {

struct KeptPicture {
  const char *scene, *file;
  ar::Image (*picture)(const Targets&);
};

/// Pictures for people; no test reads them.
constexpr KeptPicture kKept[] = {
    {"desk-01-automatic", "desk-01.png", color_picture},
    {"desk-04-automatic", "desk-04.png", color_picture},
    {"desk-04-counts", "desk-04-counts.png", stencil_picture},
};

std::map<std::string, Entry> manifest_or_none() {
  if (!std::filesystem::exists(golden_folder() / "manifest.json")) return {};
  return read_manifest();
}

void bless_all() {
  const std::map<std::string, Entry> before = manifest_or_none();
  std::map<std::string, Entry> after;
  std::map<std::string, ar::Image> pictures;
  std::size_t changed = 0;
  for (const Scene& scene : scenes()) {
    const auto start = std::chrono::steady_clock::now();
    Targets targets = scene.make_targets();
    const raster::Frame frame = scene.record(targets);
    reference::execute(frame, scene.commands(frame));
    const Entry& entry = after[scene.name] = entry_of(targets);
    for (const KeptPicture& kept : kKept)
      if (scene.name == kept.scene) pictures[kept.file] = kept.picture(targets);
    const auto old = before.find(scene.name);
    const bool same = old != before.end() && old->second == entry;
    changed += !same;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("{:28} {:9} {:6.1f} s\n", scene.name, same ? "as before" : "changed",
               seconds.count());
    std::fflush(stdout);
  }
  for (const auto& [file, picture] : pictures) ar::write_png(golden_folder() / file, picture);
  write_manifest(after);
  fmt::print("wrote {} scenes, {} of them changed, to {}\n", after.size(), changed,
             golden_folder().string());
}

}  // namespace

int bless() {
  try {
    bless_all();
    fmt::print("This run checked nothing: look at what changed, then run the tests.\n");
  } catch (const std::exception& error) {
    fmt::print(stderr, "golden_test: {}\n", error.what());
  }
  return 1;
}

}  // namespace gnomon::golden
