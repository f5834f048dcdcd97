// The folder of golden frames: recorded frames as files, and the hashes that their buffers must
// have after execution. Only the reference renderer writes it (tests/golden/bless.cpp).
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "golden/hash.h"
#include "raster/execute.h"

namespace gnomon::golden {

/// Thrown for a folder that cannot be used. what() is one line that names the file.
class FolderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the manifest says of a scene.
struct Entry {
  /// Name of the frame file, mostly the scene's own.
  std::string frame;
  /// How many of the frame's commands are executed.
  std::size_t commands = std::numeric_limits<std::size_t>::max();
  /// In the order of the frame file.
  std::vector<BufferHash> buffers;
  bool operator==(const Entry&) const = default;
};

/// Scenes by name; a name is letters, digits and dashes.
using Manifest = std::map<std::string, Entry>;

/// FOLDER/manifest.json and FOLDER/frames/NAME.frame.
std::filesystem::path manifest_path(const std::filesystem::path& folder);
std::filesystem::path frame_path(const std::filesystem::path& folder, const std::string& name);

/// Throws FolderError if it is missing, damaged or of another format.
Manifest read_manifest(const std::filesystem::path& folder);
/// The text that read_manifest reads.
std::string manifest_text(const Manifest& manifest);

/// The bytes of FOLDER/frames/NAME.frame. Throws FolderError if it cannot be read.
std::vector<std::uint8_t> read_frame_bytes(const std::filesystem::path& folder,
                                           const std::string& name);

/// The frame of these bytes after its first `commands` commands were executed. Throws FormatError.
raster::RecordedFrame replay(std::span<const std::uint8_t> frame_bytes, std::size_t commands,
                             raster::ExecuteOptions options);

}  // namespace gnomon::golden
