// The hashes that golden scenes are held to, and the file that keeps them.
// Source of the hash: Fowler, Noll and Vo, FNV-1a with 64 bits. It guards against change, not
// against malice.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "golden/scenes.h"

namespace gnomon::golden {

/// FNV-1a of the bytes as 16 hexadecimal digits.
std::string hash_of(std::span<const std::uint8_t> bytes);

/// Planes as bytes, pixel after pixel, row after row from the bottom row: colour as r, g, b, a (a
/// byte each, or an IEEE float each), depth as 4 bytes, stencil as 1. Least significant byte first.
std::vector<std::uint8_t> color_bytes(const raster::ColorBuffer& color);
std::vector<std::uint8_t> depth_bytes(const raster::DepthBuffer& depth);

/// What the manifest says of a scene.
struct Entry {
  int width = 0, height = 0;
  std::string color_format, depth_format;
  std::string color, depth, stencil;
  bool operator==(const Entry&) const = default;
};

Entry entry_of(const Targets& targets);

/// For messages of failing tests.
void PrintTo(const Entry& entry, std::ostream* out);

/// Where the repository keeps it.
std::filesystem::path golden_folder();

/// The manifest by scene. Throws std::exception with a sentence if it is missing, damaged or of
/// another format.
std::map<std::string, Entry> read_manifest();
/// Writes it, or throws and leaves what was there.
void write_manifest(const std::map<std::string, Entry>& entries);

}  // namespace gnomon::golden
