// An 8-bit picture in memory, stored from its top row as files are. Values are as in the file
// (display-referred).
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gnomon::ar {

/// Tightly packed rows from the top; 1 (grey), 3 (r, g, b) or 4 (r, g, b, a) channels.
struct Image {
  int width = 0, height = 0, channels = 3;
  std::vector<std::uint8_t> pixels;

  const std::uint8_t* at(int x, int y) const {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
  std::uint8_t* at(int x, int y) {
    return pixels.data() + (static_cast<std::size_t>(y) * width + x) * channels;
  }
};

}  // namespace gnomon::ar
