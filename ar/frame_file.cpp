#include "ar/frame_file.h"

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::ar {

raster::RecordedFrame read_frame(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = read_file(path, kMaxFrameFileBytes);
  try {
    return raster::decode_frame(bytes);
  } catch (const raster::FormatError& error) {
    throw InputError(fmt::format("{}: {}", one_line(path.string()), error.what()));
  }
}

void write_frame(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace gnomon::ar
