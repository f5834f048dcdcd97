#include "ar/mesh_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <string>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/ply_bytes.h"
#include "ar/text_words.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void fail(const fs::path& path, std::string_view what) {
  throw InputError(fmt::format("{}: {}", one_line(path.string()), one_line(what)));
}

std::string_view text_of(Bytes bytes, std::size_t limit = std::string_view::npos) {
  return {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), limit)};
}

std::uint32_t u32(Bytes bytes, std::size_t at) {
  return std::uint32_t{bytes[at + 3]} << 24 | std::uint32_t{bytes[at + 2]} << 16 |
         std::uint32_t{bytes[at + 1]} << 8 | bytes[at];
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::uint64_t count_of(const fs::path& path, std::string_view word, std::string_view what) {
  const std::optional<std::uint64_t> count = parse_count(word);
  if (!count) fail(path, fmt::format("{}: '{}' is no count", what, word.substr(0, 40)));
  return *count;
}

void require_number(const fs::path& path, std::string_view word, std::string_view what,
                    std::uint64_t number) {
  if (!is_number(word))
    fail(path, fmt::format("{} {}: '{}' is no number", what, number, word.substr(0, 40)));
}

constexpr std::size_t kStlHeader = 84, kStlTriangle = 50;

bool is_binary_stl(Bytes bytes) {
  return bytes.size() >= kStlHeader &&
         bytes.size() == kStlHeader + std::uint64_t{u32(bytes, 80)} * kStlTriangle;
}

bool is_text_stl(Bytes bytes) {
  std::string_view text = text_of(bytes, 4096);
  if (lower(next_word(text)) != "solid") return false;
  const std::string rest = lower(text);
  return rest.find("facet") != std::string::npos || rest.find("endsolid") != std::string::npos;
}

/// OFF with any of Geomview's prefixes for what a vertex has.
bool is_off(Bytes bytes) {
  std::string_view text = text_of(bytes, 64);
  const std::string_view word = next_word(text);
  return word.size() <= 8 && word.ends_with("OFF") &&
         word.substr(0, word.size() - 3).find_first_not_of("STCN4n") == std::string_view::npos;
}

void check_stl(Bytes bytes, const fs::path& path) {
  if (is_binary_stl(bytes) || is_text_stl(bytes)) return;
  if (bytes.size() < kStlHeader) fail(path, fmt::format("{} bytes are no STL file", bytes.size()));
  const std::uint64_t triangles = u32(bytes, 80);
  fail(path, fmt::format("{} triangles of a binary STL file are {} bytes, but the file has {}",
                         triangles, kStlHeader + triangles * kStlTriangle, bytes.size()));
}

/// The lines of a text that hold something, without comments.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  /// The next one; nothing at the end.
  std::optional<std::string_view> next() {
    while (!text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      line = line.substr(0, line.find('#'));
      std::string_view rest = line;
      if (!next_word(rest).empty()) return line;
    }
    return std::nullopt;
  }

 private:
  std::string_view text_;
};

void check_off(Bytes bytes, const fs::path& path) {
  std::string_view text = text_of(bytes);
  const std::string_view mark = next_word(text);
  if (!mark.ends_with("OFF")) fail(path, "is no OFF file: it does not begin with OFF");
  if (mark != "OFF")
    fail(path, fmt::format("a file of the kind {}; plain OFF is read", mark.substr(0, 8)));
  Lines lines(text);
  std::string_view counts = lines.next().value_or("");
  const std::uint64_t vertices = count_of(path, next_word(counts), "OFF: number of vertices");
  const std::uint64_t faces = count_of(path, next_word(counts), "OFF: number of faces");
  for (std::uint64_t v = 0; v < vertices; ++v) {
    std::optional<std::string_view> line = lines.next();
    if (!line) fail(path, fmt::format("OFF: {} vertices are announced, {} are there", vertices, v));
    for (int c = 0; c < 3; ++c) require_number(path, next_word(*line), "OFF: vertex", v);
  }
  for (std::uint64_t f = 0; f < faces; ++f) {
    std::optional<std::string_view> line = lines.next();
    if (!line) fail(path, fmt::format("OFF: {} faces are announced, {} are there", faces, f));
    const std::uint64_t corners = count_of(path, next_word(*line), fmt::format("OFF: face {}", f));
    for (std::uint64_t k = 0; k < corners; ++k)
      if (const std::uint64_t index =
              count_of(path, next_word(*line), fmt::format("OFF: face {}", f));
          index >= vertices)
        fail(path, fmt::format("OFF: face {}: index {} is not below the {} vertices", f, index,
                               vertices));
  }
}

/// Chunks that hold chunks: MAIN, EDIT3DS, and the two that keyframes hang below.
constexpr std::array<std::uint16_t, 4> kChunksOfChunks{0x4d4d, 0x3d3d, 0xb000, 0xb002};

void check_3ds(Bytes bytes, const fs::path& path, std::size_t begin, std::size_t end, int depth) {
  std::size_t at = begin;
  while (at + 6 <= end) {
    const auto id = static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
    const std::uint32_t length = u32(bytes, at + 2);
    if (length < 6 || length > end - at)
      fail(path, fmt::format("3DS: chunk {:#06x} at byte {} has {} bytes where {} are left", id, at,
                             length, end - at));
    if (depth < 4 &&
        std::find(kChunksOfChunks.begin(), kChunksOfChunks.end(), id) != kChunksOfChunks.end())
      check_3ds(bytes, path, at + 6, at + length, depth + 1);
    at += length;
  }
}

}  // namespace

MeshFormat mesh_format(Bytes bytes, const fs::path& path) {
  std::string_view text = text_of(bytes, 256);
  const std::string_view first = next_word(text);
  if (first.starts_with("glTF") || first.starts_with("{")) return MeshFormat::gltf;
  if (lower(first) == "ply") return MeshFormat::ply;
  if (is_off(bytes)) return MeshFormat::off;
  if (is_binary_stl(bytes) || is_text_stl(bytes)) return MeshFormat::stl;
  if (bytes.size() >= 6 && bytes[0] == 0x4d && bytes[1] == 0x4d && u32(bytes, 2) == bytes.size())
    return MeshFormat::three_ds;
  static const std::map<std::string, MeshFormat> kByExtension{
      {".glb", MeshFormat::gltf},    {".gltf", MeshFormat::gltf}, {".obj", MeshFormat::obj},
      {".off", MeshFormat::off},     {".stl", MeshFormat::stl},   {".ply", MeshFormat::ply},
      {".3ds", MeshFormat::three_ds}};
  const auto known = kByExtension.find(lower(path.extension().string()));
  return known == kByExtension.end() ? MeshFormat::unknown : known->second;
}

void check_mesh_bytes(MeshFormat format, Bytes bytes, const fs::path& path) {
  switch (format) {
    case MeshFormat::stl:
      return check_stl(bytes, path);
    case MeshFormat::off:
      return check_off(bytes, path);
    case MeshFormat::ply:
      if (lower(text_of(bytes, 3)) != "ply") fail(path, "is no PLY file");
      return check_ply_bytes(bytes, path);
    case MeshFormat::three_ds:
      if (bytes.size() < 6 || bytes[0] != 0x4d || bytes[1] != 0x4d) fail(path, "is no 3DS file");
      return check_3ds(bytes, path, 0, bytes.size(), 0);
    case MeshFormat::obj:
      if (text_of(bytes).find('\0') != std::string_view::npos)
        fail(path, "is no OBJ file: it holds bytes that are no text");
      return;
    case MeshFormat::gltf:
      return;
    case MeshFormat::unknown:
      fail(path, fmt::format("'{}' is no model format that is read; {} are",
                             path.extension().string(), kMeshExtensions));
  }
}

}  // namespace gnomon::ar
