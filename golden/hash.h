// Hashes of buffers, the thing that golden frames are held to.
// Source: Fowler, Noll and Vo, FNV-1a with 64 bits. It guards against change, not against malice.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "raster/frame_format.h"

namespace gnomon::golden {

/// FNV-1a of the bytes as 16 hexadecimal digits.
std::string hash_of(std::span<const std::uint8_t> bytes);

/// A buffer as bytes, pixel after pixel, row after row from the bottom row: colour as r, g, b, a (a
/// byte each, or an IEEE float each), depth as 4 bytes, stencil as 1. Least significant byte first.
std::vector<std::uint8_t> bytes_of(const raster::Buffer& buffer);

struct BufferHash {
  /// "color", "depth" or "stencil".
  std::string kind;
  /// "rgba8", "rgba32f", "d24", "d16" or "s8".
  std::string format;
  int width = 0, height = 0;
  std::string hash;
  bool operator==(const BufferHash&) const = default;
};

BufferHash hash_of(const raster::Buffer& buffer);

/// Of all buffers, in their order.
std::vector<BufferHash> hashes_of(const raster::RecordedFrame& recorded);

/// "depth d24 160x120 3ea0caf9e0892c2e".
std::string sentence(const BufferHash& hash);

/// For messages of failing tests.
void PrintTo(const BufferHash& hash, std::ostream* out);

}  // namespace gnomon::golden
