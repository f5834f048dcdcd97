// Bytes out and in, least significant first whatever the machine. The reader trusts no byte: it
// compares every length with what is left before it hands anything out.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "raster/frame_format.h"

namespace gnomon::raster {

class ByteWriter {
 public:
  void u8(std::uint8_t value) { bytes_.push_back(value); }
  void u32(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
      bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
  }
  void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
  void bytes(std::span<const std::uint8_t> values) {
    bytes_.insert(bytes_.end(), values.begin(), values.end());
  }
  void text(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Each function takes the name of what is read, for the sentence of a FormatError.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t offset() const { return offset_; }
  std::size_t left() const { return bytes_.size() - offset_; }

  std::span<const std::uint8_t> bytes(std::uint64_t count, std::string_view what) {
    if (count > left())
      fail(offset_, std::string(what) + " takes " + std::to_string(count) + " bytes, but " +
                        std::to_string(left()) + " are left");
    const auto found = bytes_.subspan(offset_, static_cast<std::size_t>(count));
    offset_ += found.size();
    return found;
  }
  std::uint8_t u8(std::string_view what) { return bytes(1, what)[0]; }
  std::uint32_t u32(std::string_view what) {
    const auto b = bytes(4, what);
    return std::uint32_t{b[0]} | std::uint32_t{b[1]} << 8 | std::uint32_t{b[2]} << 16 |
           std::uint32_t{b[3]} << 24;
  }
  float f32(std::string_view what) { return std::bit_cast<float>(u32(what)); }

  [[noreturn]] static void fail(std::size_t offset, const std::string& sentence) {
    throw FormatError("byte " + std::to_string(offset) + ": " + sentence);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t offset_ = 0;
};

}  // namespace gnomon::raster
