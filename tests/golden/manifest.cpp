#include "golden/manifest.h"

#include <bit>
#include <ostream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::golden {
namespace {

constexpr const char* kFormat = "gnomon-golden 1";
constexpr std::uint64_t kLargestManifest = 1 << 20;

std::filesystem::path manifest_file() { return golden_folder() / "manifest.json"; }

void append_word(std::vector<std::uint8_t>& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

}  // namespace

std::string hash_of(std::span<const std::uint8_t> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  return fmt::format("{:016x}", hash);
}

std::vector<std::uint8_t> color_bytes(const raster::ColorBuffer& color) {
  if (color.format() == raster::ColorFormat::rgba8) return color.to_rgba8_rows();
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < color.height(); ++y)
    for (int x = 0; x < color.width(); ++x) {
      const glm::vec4 c = color.rgba32f().at(x, y);
      for (int i = 0; i < 4; ++i) append_word(bytes, std::bit_cast<std::uint32_t>(c[i]));
    }
  return bytes;
}

std::vector<std::uint8_t> depth_bytes(const raster::DepthBuffer& depth) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint32_t value : depth.to_rows()) append_word(bytes, value);
  return bytes;
}

Entry entry_of(const Targets& targets) {
  return {
      .width = targets.color.width(),
      .height = targets.color.height(),
      .color_format = targets.color.format() == raster::ColorFormat::rgba8 ? "rgba8" : "rgba32f",
      .depth_format = targets.depth.format() == raster::DepthFormat::d24 ? "d24" : "d16",
      .color = hash_of(color_bytes(targets.color)),
      .depth = hash_of(depth_bytes(targets.depth)),
      .stencil = hash_of(targets.stencil.to_rows())};
}

void PrintTo(const Entry& e, std::ostream* out) {
  *out << fmt::format("{}x{} {} {} color {} depth {} stencil {}", e.width, e.height, e.color_format,
                      e.depth_format, e.color, e.depth, e.stencil);
}

std::filesystem::path golden_folder() {
  return std::filesystem::path(GNOMON_SOURCE_DIR) / "golden";
}

std::map<std::string, Entry> read_manifest() {
  const std::vector<std::uint8_t> bytes = ar::read_file(manifest_file(), kLargestManifest);
  const nlohmann::json json = nlohmann::json::parse(bytes);
  if (json.at("format") != kFormat)
    throw ar::InputError(manifest_file().string() + ": format: is not \"" + kFormat + "\"");
  std::map<std::string, Entry> entries;
  for (const auto& [name, e] : json.at("scenes").items())
    entries[name] = {e.at("width"), e.at("height"), e.at("color_format"), e.at("depth_format"),
                     e.at("color"), e.at("depth"),  e.at("stencil")};
  return entries;
}

void write_manifest(const std::map<std::string, Entry>& entries) {
  nlohmann::ordered_json scenes;
  for (const auto& [name, e] : entries)
    scenes[name] = {{"width", e.width},
                    {"height", e.height},
                    {"color_format", e.color_format},
                    {"depth_format", e.depth_format},
                    {"color", e.color},
                    {"depth", e.depth},
                    {"stencil", e.stencil}};
  const nlohmann::ordered_json json{{"format", kFormat}, {"hash", "FNV-1a 64"}, {"scenes", scenes}};
  ar::write_file(manifest_file(), json.dump(2) + "\n");
}

}  // namespace gnomon::golden
