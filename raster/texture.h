// A two-dimensional RGBA8 texture. Texel row 0 is at t = 0, as in OpenGL.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/buffers.h"

namespace gnomon::raster {

enum class Wrap : std::uint8_t { repeat, clamp_to_edge, mirrored_repeat };
enum class Filter : std::uint8_t { nearest, linear };

/// Effect of a lookup: OpenGL 4.6, section 8.14, without mipmaps.
struct Texture {
  int width = 0, height = 0;
  /// width * height texels, row after row from t = 0.
  std::vector<Rgba8> texels;
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  Filter filter = Filter::linear;
};

/// The texture's value at (s, t), channels in [0, 1].
/// Preconditions: width and height positive, width * height texels. A coordinate that is not finite
/// reads as 0.
glm::vec4 sample(const Texture& texture, float s, float t);

}  // namespace gnomon::raster
