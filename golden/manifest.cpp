#include "golden/manifest.h"

#include <algorithm>
#include <fstream>
#include <initializer_list>

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

void require(bool holds, const std::string& file, const std::string& scene, const char* rule) {
  if (!holds) throw FolderError(file + ": scene '" + scene + "': " + rule);
}

bool is_hash(const std::string& text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Only the keys that are named here; a misspelt one would be a check that is not made.
void require_keys(const nlohmann::json& object, std::initializer_list<const char*> keys,
                  const std::string& file, const std::string& scene) {
  require(object.is_object(), file, scene, "an entry is no table");
  for (const auto& item : object.items())
    if (std::ranges::none_of(keys, [&](const char* key) { return item.key() == key; }))
      throw FolderError(file + ": scene '" + scene + "': there is no key '" + item.key() + "'");
}

BufferHash buffer_from_json(const nlohmann::json& b, const std::string& file,
                            const std::string& scene) {
  require_keys(b, {"kind", "format", "width", "height", "hash"}, file, scene);
  BufferHash buffer{b.at("kind"), b.at("format"), b.at("width"), b.at("height"), b.at("hash")};
  const bool known =
      (buffer.kind == "color" && (buffer.format == "rgba8" || buffer.format == "rgba32f")) ||
      (buffer.kind == "depth" && (buffer.format == "d24" || buffer.format == "d16")) ||
      (buffer.kind == "stencil" && buffer.format == "s8");
  require(known, file, scene, "a buffer's kind and format are none of gnomon's");
  const auto is_side = [](int side) { return side >= 1 && side <= raster::kMaxTargetSize; };
  require(is_side(buffer.width) && is_side(buffer.height), file, scene,
          "a buffer is 1 to 16384 pixels wide and high");
  require(is_hash(buffer.hash), file, scene, "a hash is 16 hexadecimal digits");
  return buffer;
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
    require_keys(scene, {"frame", "commands", "buffers"}, file, name);
    if (scene.contains("commands")) {
      require(scene.at("commands").is_number_unsigned(), file, name,
              "a number of commands is a whole number from 0");
      entry.commands = scene.at("commands");
    }
    for (const nlohmann::json& b : scene.at("buffers"))
      entry.buffers.push_back(buffer_from_json(b, file, name));
    require(!entry.buffers.empty(), file, name, "it has no buffer");
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
    // Its first words are the library's own: "[json.exception.type_error.302] ".
    const std::string text = error.what();
    throw FolderError(file + ": " + text.substr(std::min(text.size(), text.find("] ") + 2)));
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
