// Recorded frames in and out of files (docs/frame-format.md).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "raster/frame_format.h"

namespace gnomon::ar {

/// Largest file that is read, in bytes.
inline constexpr std::uint64_t kMaxFrameFileBytes = std::uint64_t{1} << 31;

/// The frame of a file, on fresh buffers. Throws InputError, which names the file and the offset of
/// what is wrong in it.
raster::RecordedFrame read_frame(const std::filesystem::path& path);

/// Writes an encoded frame (raster::encode_frame) beside `path`, then renames it. Throws InputError
/// if it cannot be written.
void write_frame(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace gnomon::ar
