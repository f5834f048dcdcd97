#include "golden/manifest.h"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

namespace gnomon::golden {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "gnomon-golden 2";
constexpr const char* kHash = "FNV-1a 64";
constexpr std::uint64_t kLargestManifest = 1 << 20;
constexpr std::uint64_t kLargestFrame = 64 << 20;
/// Memory of one frame's buffers.
constexpr std::uint64_t kLargestBuffers = std::uint64_t{1} << 30;
constexpr std::size_t kAllCommands = std::numeric_limits<std::size_t>::max();

std::vector<std::uint8_t> read_file(const fs::path& path, std::uint64_t largest) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) throw FolderError(path.string() + ": no such file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size > largest)
    throw FolderError(path.string() + ": more than the " + std::to_string(largest) +
                      " bytes accepted");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  std::ifstream in(path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    throw FolderError(path.string() + ": cannot be read");
  return bytes;
}

/// A frame's name becomes a path, which may lead nowhere else.
bool is_name(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

Manifest from_json(const nlohmann::json& json, const std::string& file) {
  if (json.at("format") != kFormat || json.at("hash") != kHash)
    throw FolderError(file + ": its format is not " + kFormat + " with " + kHash);
  Manifest manifest;
  for (const auto& [name, scene] : json.at("scenes").items()) {
    Entry& entry = manifest[name];
    entry.frame = scene.at("frame");
    if (!is_name(entry.frame))
      throw FolderError(file + ": scene '" + name + "': its frame is '" + entry.frame +
                        "', but a name is lower-case letters, digits and dashes");
    entry.commands = scene.value("commands", kAllCommands);
    for (const nlohmann::json& b : scene.at("buffers"))
      entry.buffers.push_back(
          {b.at("kind"), b.at("format"), b.at("width"), b.at("height"), b.at("hash")});
  }
  if (manifest.empty()) throw FolderError(file + ": it has no scene");
  return manifest;
}

}  // namespace

fs::path manifest_path(const fs::path& folder) { return folder / "manifest.json"; }

fs::path frame_path(const fs::path& folder, const std::string& name) {
  return folder / "frames" / (name + ".frame");
}

Manifest read_manifest(const fs::path& folder) {
  const std::string file = manifest_path(folder).string();
  const std::vector<std::uint8_t> bytes = read_file(file, kLargestManifest);
  try {
    return from_json(nlohmann::json::parse(bytes), file);
  } catch (const nlohmann::json::exception& error) {
    throw FolderError(file + ": " + error.what());
  }
}

std::string manifest_text(const Manifest& manifest) {
  // A buffer a line: a whole dump would take seven.
  std::string text = std::string("{\n  \"format\": \"") + kFormat + "\",\n  \"hash\": \"" + kHash +
                     "\",\n  \"scenes\": {";
  const char* before_scene = "\n";
  for (const auto& [name, entry] : manifest) {
    text += before_scene + ("    \"" + name + "\": {\n");
    text += "      \"frame\": \"" + entry.frame + "\",\n";
    if (entry.commands != kAllCommands)
      text += "      \"commands\": " + std::to_string(entry.commands) + ",\n";
    text += "      \"buffers\": [";
    const char* before_buffer = "\n";
    for (const BufferHash& b : entry.buffers) {
      const nlohmann::ordered_json line{{"kind", b.kind},
                                        {"format", b.format},
                                        {"width", b.width},
                                        {"height", b.height},
                                        {"hash", b.hash}};
      text += before_buffer + ("        " + line.dump());
      before_buffer = ",\n";
    }
    text += "\n      ]\n    }";
    before_scene = ",\n";
  }
  return text + "\n  }\n}\n";
}

std::vector<std::uint8_t> read_frame_bytes(const fs::path& folder, const std::string& name) {
  return read_file(frame_path(folder, name), kLargestFrame);
}

raster::RecordedFrame replay(std::span<const std::uint8_t> frame_bytes, std::size_t commands,
                             raster::ExecuteOptions options) {
  raster::RecordedFrame recorded = raster::decode_frame(frame_bytes, kLargestBuffers);
  options.commands = commands;
  raster::execute(recorded.frame, options);
  return recorded;
}

}  // namespace gnomon::golden
