#include "ar/png_chunks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gnomon::ar {

namespace {

constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    table[n] = c;
  }
  return table;
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = make_crc_table();
  std::uint32_t c = 0xffffffffu;
  for (const std::uint8_t byte : bytes) c = kTable[(c ^ byte) & 0xffu] ^ (c >> 8);
  return ~c;
}

std::uint32_t big_endian(std::span<const std::uint8_t> b) {
  return std::uint32_t{b[0]} << 24 | std::uint32_t{b[1]} << 16 | std::uint32_t{b[2]} << 8 | b[3];
}

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && std::equal(bytes.begin(), bytes.begin() + 4, kSignature.begin());
}

std::optional<std::string> png_fault(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kSignature.size() ||
      !std::equal(kSignature.begin(), kSignature.end(), bytes.begin()))
    return "damaged: does not begin as a PNG file";
  std::size_t at = kSignature.size();
  for (bool first = true;; first = false) {
    // A chunk is length, type, data, check sum: 12 bytes beside the data.
    if (bytes.size() - at < 12) return fmt::format("truncated: ends at byte {}", bytes.size());
    const std::uint32_t length = big_endian(bytes.subspan(at, 4));
    const auto type = bytes.subspan(at + 4, 4);
    const auto is = [type](std::string_view name) {
      return std::equal(type.begin(), type.end(), name.begin());
    };
    if (!std::all_of(type.begin(), type.end(), [](std::uint8_t c) {
          return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        }))
      return fmt::format("damaged: no chunk at byte {}", at);
    const std::string name(type.begin(), type.end());
    if (length > bytes.size() - at - 12)
      return fmt::format("truncated: chunk {} at byte {} has {} bytes, the file ends at byte {}",
                         name, at, length, bytes.size());
    if (first && !is("IHDR")) return fmt::format("damaged: begins with chunk {}, not IHDR", name);
    if (crc32(bytes.subspan(at + 4, length + std::size_t{4})) !=
        big_endian(bytes.subspan(at + 8 + length, 4)))
      return fmt::format("damaged: wrong check sum of chunk {} at byte {}", name, at);
    if (is("IEND")) return std::nullopt;
    at += std::size_t{12} + length;
  }
}

}  // namespace gnomon::ar
