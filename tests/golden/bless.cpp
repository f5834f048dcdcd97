#include "golden/bless.h"

#include <chrono>
#include <cstdio>
#include <exception>

#include <fmt/format.h>

#include "ar/buffer_picture.h"
#include "ar/file.h"
#include "ar/image_file.h"
#include "golden/manifest.h"
#include "golden/scenes.h"
#include "reference/reference.h"

namespace gnomon::golden {
namespace {

const std::filesystem::path kFolder = GNOMON_SOURCE_DIR "/golden";

struct KeptPicture {
  const char *scene, *file;
  /// Of the buffers, in the frame file's order.
  std::size_t buffer;
};

/// Pictures for people; no test reads them.
constexpr KeptPicture kKept[] = {
    {"desk-01-automatic", "desk-01.png", 0},
    {"desk-04-automatic", "desk-04.png", 0},
    {"desk-04-counts", "desk-04-counts.png", 2},
};

void write_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  ar::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Manifest manifest_or_none() {
  if (!std::filesystem::exists(manifest_path(kFolder))) return {};
  return read_manifest(kFolder);
}

void bless_all() {
  const Manifest before = manifest_or_none();
  Manifest after;
  std::size_t changed = 0, frame_bytes = 0;
  std::filesystem::create_directories(frame_path(kFolder, "").parent_path());
  for (const Scene& scene : scenes()) {
    const auto start = std::chrono::steady_clock::now();
    const raster::RecordedFrame recorded = scene.record();
    const std::vector<std::uint8_t> bytes = raster::encode_frame(recorded.frame);
    const raster::RecordedFrame replayed = raster::decode_frame(bytes);
    const std::size_t commands = scene.commands(recorded.frame);
    reference::execute(replayed.frame, commands);
    const Entry& entry = after[scene.name] = {scene.frame_name(), commands, hashes_of(replayed)};
    if (scene.frame_of.empty()) write_bytes(frame_path(kFolder, scene.name), bytes);
    for (const KeptPicture& kept : kKept)
      if (scene.name == kept.scene)
        ar::write_png(kFolder / kept.file, ar::buffer_picture(replayed.buffers[kept.buffer]));
    const auto old = before.find(scene.name);
    const bool same = old != before.end() && old->second == entry;
    changed += !same;
    if (scene.frame_of.empty()) frame_bytes += bytes.size();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    fmt::print("{:28} {:9} {:8} bytes {:6.1f} s\n", scene.name, same ? "as before" : "changed",
               bytes.size(), seconds.count());
    std::fflush(stdout);
  }
  ar::write_file(manifest_path(kFolder), manifest_text(after));
  fmt::print("wrote {} scenes ({} bytes of frames), {} of them changed, to {}\n", after.size(),
             frame_bytes, changed, kFolder.string());
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
