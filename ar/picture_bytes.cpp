#include "ar/picture_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "ar/error.h"
#include "ar/file.h"

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

[[noreturn]] void fail(std::string_view name, std::string_view what) {
  throw InputError(fmt::format("{}: {}", one_line(name), what));
}

bool starts_with(std::span<const std::uint8_t> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(),
                    [](char c, std::uint8_t b) { return static_cast<std::uint8_t>(c) == b; });
}

void append(std::vector<std::uint8_t>& out, std::span<const std::uint8_t> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

std::string_view picture_format(std::span<const std::uint8_t> bytes) {
  if (starts_with(bytes, "\x89PNG")) return "png";
  if (starts_with(bytes, "\xff\xd8\xff")) return "jpeg";
  if (starts_with(bytes, "BM")) return "bmp";
  if (starts_with(bytes, "v/1\x01")) return "openexr";
  if (starts_with(bytes, "#?")) return "hdr";
  if (bytes.size() >= 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6') return "pnm";
  return "";
}

std::vector<std::uint8_t> bare_png(std::span<const std::uint8_t> bytes, std::string_view name) {
  if (bytes.size() < kSignature.size() ||
      !std::equal(kSignature.begin(), kSignature.end(), bytes.begin()))
    fail(name, "damaged: does not begin as a PNG file");
  std::vector<std::uint8_t> bare(kSignature.begin(), kSignature.end());
  std::size_t at = kSignature.size();
  for (bool first = true;; first = false) {
    // A chunk is length, type, data, check sum: 12 bytes beside the data.
    if (bytes.size() - at < 12) fail(name, fmt::format("truncated: ends at byte {}", bytes.size()));
    const std::uint32_t length = big_endian(bytes.subspan(at, 4));
    const auto type = bytes.subspan(at + 4, 4);
    if (!std::all_of(type.begin(), type.end(), [](std::uint8_t c) {
          return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
        }))
      fail(name, fmt::format("damaged: no chunk at byte {}", at));
    const std::string chunk(type.begin(), type.end());
    if (length > bytes.size() - at - 12)
      fail(name,
           fmt::format("truncated: chunk {} at byte {} has {} bytes, the file ends at byte {}",
                       chunk, at, length, bytes.size()));
    if (first && chunk != "IHDR")
      fail(name, fmt::format("damaged: begins with chunk {}, not IHDR", chunk));
    if (crc32(bytes.subspan(at + 4, length + std::size_t{4})) !=
        big_endian(bytes.subspan(at + 8 + length, 4)))
      fail(name, fmt::format("damaged: wrong check sum of chunk {} at byte {}", chunk, at));
    const std::size_t size = std::size_t{12} + length;
    // A capital first letter says that the picture cannot be shown without the chunk.
    if (chunk[0] <= 'Z' || chunk == "tRNS") append(bare, bytes.subspan(at, size));
    if (chunk == "IEND") return bare;
    at += size;
  }
}

std::vector<std::uint8_t> bare_jpeg(std::span<const std::uint8_t> bytes, std::string_view name) {
  constexpr std::uint8_t kStartOfScan = 0xda, kEnd = 0xd9, kComment = 0xfe;
  constexpr std::uint8_t kJfif = 0xe0, kAdobe = 0xee;
  std::vector<std::uint8_t> bare(bytes.begin(), bytes.begin() + 2);
  std::size_t at = 2;
  while (true) {
    if (bytes.size() - at < 4) fail(name, fmt::format("truncated: ends at byte {}", bytes.size()));
    if (bytes[at] != 0xff) fail(name, fmt::format("damaged: no marker at byte {}", at));
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xff) {
      ++at;
      continue;
    }
    if (marker == kStartOfScan || marker == kEnd) {
      append(bare, bytes.subspan(at));
      return bare;
    }
    const bool alone = marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
    const std::size_t length = alone ? 0 : std::size_t{bytes[at + 2]} << 8 | bytes[at + 3];
    if (!alone && (length < 2 || length > bytes.size() - at - 2))
      fail(name, fmt::format("truncated: segment {:02x} at byte {} has {} bytes, the file ends at "
                             "byte {}",
                             marker, at, length, bytes.size()));
    const bool application = marker >= 0xe0 && marker <= 0xef;
    if (!(application && marker != kJfif && marker != kAdobe) && marker != kComment)
      append(bare, bytes.subspan(at, 2 + length));
    at += 2 + length;
  }
}

}  // namespace gnomon::ar
