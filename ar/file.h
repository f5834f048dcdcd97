// Files whole or not at all: reading within a bound, and writing beside the target, then renaming
// over it, so that no reader ever sees half a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gnomon::ar {

/// The text with line breaks and other control characters replaced by spaces and the ends trimmed,
/// for messages that must stay one line.
std::string one_line(std::string_view text);

/// The bytes of a regular file.
/// Throws InputError if the path is missing, is no regular file, cannot be read, or holds more than
/// `max_bytes` (checked before memory is taken).
std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uint64_t max_bytes);

/// A file that is being written under a temporary name in the target's own folder.
/// Invariant: until commit() the target is untouched; without commit() nothing stays behind.
class PendingFile {
 public:
  /// Throws InputError if the folder is missing or cannot be written to, or the target is there and
  /// no regular file.
  explicit PendingFile(std::filesystem::path target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write. Has the target's extension, because writers choose the format by it.
  const std::filesystem::path& temporary() const { return temporary_; }
  const std::filesystem::path& target() const { return target_; }

  /// Renames the temporary file to the target. Throws InputError if that fails.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

/// Writes a whole file, or throws InputError and leaves what was there.
void write_file(const std::filesystem::path& path, std::string_view contents);

}  // namespace gnomon::ar
