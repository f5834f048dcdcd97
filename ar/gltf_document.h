// A glTF file in memory, and its numbers behind bounds checks. Internal to ar/: shows tinygltf.
// tinygltf validates nothing, so what it would trip over is refused before it sees the file
// (load_document) and what it hands over is checked where it is used (read_floats, read_indices).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

namespace gnomon::ar::gltf {

/// Bounds on what a file may make the reader allocate.
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{512} << 20;
inline constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{128} << 20;
inline constexpr std::uint64_t kMaxBufferBytes = std::uint64_t{1} << 30;
inline constexpr std::size_t kMaxElements = 1'000'000;
inline constexpr int kMaxDepth = 64;
inline constexpr std::size_t kMaxVertices = 24'000'000;

struct Document {
  std::filesystem::path path;
  tinygltf::Model gltf;
  /// Each node's `extras` as JSON text, empty without.
  std::vector<std::string> node_extras;
};

/// Throws InputError "FILE: WHERE: what".
[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what);

/// Reads the file, its buffers and its encoded pictures. Pictures are not decoded; those in a
/// buffer view stay there. Throws InputError.
Document load_document(const std::filesystem::path& path);
/// The same where the file's own bytes are at hand.
Document load_document(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

/// The bytes [0, byteLength) of a buffer view. `place` begins the message of an InputError.
struct Bytes {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};
Bytes view_bytes(const Document& document, int view, const std::string& place);

/// An accessor's values as floats, `components` a value; integers are normalised where the accessor
/// says so. Throws InputError, also for a value that is not finite.
std::vector<float> read_floats(const Document& document, int accessor, int components,
                               const std::string& place);

/// Number of components of an accessor's type (1 to 16). Throws InputError for an unknown accessor
/// or type.
int component_count(const Document& document, int accessor, const std::string& place);

/// Number of values of an accessor, at most kMaxVertices. Throws InputError.
std::size_t value_count(const Document& document, int accessor, const std::string& place);

/// An accessor's unsigned integers (1, 2 or 4 bytes). Throws InputError.
std::vector<std::uint32_t> read_indices(const Document& document, int accessor,
                                        const std::string& place);

}  // namespace gnomon::ar::gltf
