#include "ar/mesh_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <string>
#include <vector>

#include "ar/error.h"
#include "ar/file.h"

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

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// The text's words, one after the other; empty at its end.
std::string_view next_word(std::string_view& text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  std::size_t length = 0;
  while (length < text.size() && !is_space(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::uint64_t count_of(const fs::path& path, std::string_view word, std::string_view what) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    fail(path, fmt::format("{}: '{}' is no count", what, word.substr(0, 40)));
  return value;
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

void check_off(Bytes bytes, const fs::path& path) {
  std::string_view text = text_of(bytes);
  std::string_view word = next_word(text);
  if (!word.ends_with("OFF")) fail(path, "is no OFF file: it does not begin with OFF");
  if (word != "OFF")
    fail(path, fmt::format("a file of the kind {}; plain OFF is read", word.substr(0, 8)));
  const auto next_value = [&] {
    while ((word = next_word(text)).starts_with('#')) {
      const std::size_t line = text.find('\n');
      text.remove_prefix(line == std::string_view::npos ? text.size() : line);
    }
    return word;
  };
  next_value();
  if (word == "BINARY") fail(path, "a binary OFF file; text is read");
  const std::uint64_t vertices = count_of(path, word, "OFF: number of vertices");
  const std::uint64_t faces = count_of(path, next_value(), "OFF: number of faces");
  // A vertex is three numbers, a face at least its count, in digits and spaces.
  if (vertices > text.size() / 6 || faces > text.size() / 2)
    fail(path, fmt::format("{} vertices and {} faces do not fit into the {} bytes that follow",
                           vertices, faces, text.size()));
}

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  /// Least bytes of one in a binary file, least values in a text.
  std::uint64_t bytes = 0, values = 0;
};

void check_ply(Bytes bytes, const fs::path& path) {
  static const std::map<std::string, int> kSizes{
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const std::string_view text = text_of(bytes);
  std::vector<PlyElement> elements;
  std::string format;
  std::size_t at = 0;
  bool ended = false;
  while (!ended) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) fail(path, "PLY: the header has no end_header");
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    const std::string shown(line.substr(0, 60));
    const std::string_view keyword = next_word(line);
    const auto size_of = [&](std::string_view type) {
      const auto size = kSizes.find(std::string(type));
      if (size == kSizes.end()) fail(path, fmt::format("PLY: \"{}\": unknown type", shown));
      return static_cast<std::uint64_t>(size->second);
    };
    if (keyword == "end_header") {
      ended = true;
    } else if (keyword == "format") {
      format = next_word(line);
    } else if (keyword == "element") {
      PlyElement element{std::string(next_word(line))};
      element.count = count_of(path, next_word(line), fmt::format("PLY: \"{}\"", shown));
      elements.push_back(element);
    } else if (keyword == "property") {
      if (elements.empty()) fail(path, fmt::format("PLY: \"{}\": before any element", shown));
      const std::string_view type = next_word(line);
      // A list may be empty: then it is its count alone.
      elements.back().bytes += size_of(type == "list" ? next_word(line) : type);
      elements.back().values += 1;
    }
  }
  if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian")
    fail(path, fmt::format("PLY: format '{}' is not read", format.substr(0, 40)));
  std::uint64_t left = bytes.size() - at;
  for (const PlyElement& element : elements) {
    // A value in a text is a digit and a space; the last may lack the space.
    const std::uint64_t least = format == "ascii" ? 2 * element.values : element.bytes;
    if (least == 0 && element.count > 0)
      fail(path, fmt::format("PLY: element {} has no property", element.name.substr(0, 40)));
    if (element.count > 0 && element.count > (left + 1) / least)
      fail(path, fmt::format("PLY: {} of element {} do not fit into the {} bytes that are left",
                             element.count, element.name.substr(0, 40), left));
    left -= std::min(left, element.count * least);
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
      return check_ply(bytes, path);
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
