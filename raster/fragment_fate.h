// What becomes of a fragment: what is stored at its pixel, and where its way ends (OpenGL 4.6,
// section 17.3).
#pragma once

#include <cstdint>

#include <glm/vec4.hpp>

namespace gnomon::raster {

/// What is stored at a pixel; what no target holds is 0.
struct PixelValues {
  /// As ColorBuffer::at gives it: 8-bit channels as c / 255.
  glm::vec4 color{0.0f};
  std::uint32_t depth = 0;
  std::uint8_t stencil = 0;
};

/// Where a fragment's way ended.
enum class Outcome : std::uint8_t { stencil_fail, depth_fail, pass };

/// "stencil test failed", "depth test failed" or "passed".
constexpr const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::stencil_fail:
      return "stencil test failed";
    case Outcome::depth_fail:
      return "depth test failed";
    case Outcome::pass:
      return "passed";
  }
  return "";
}

}  // namespace gnomon::raster
