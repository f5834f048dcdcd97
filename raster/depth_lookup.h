// A depth buffer read as a texture with comparison: shadow maps (OpenGL 4.6, section 8.23.1;
// Williams 1978; the 2x2 filter is the percentage-closer one of Reeves, Salesin and Cook 1987).
//
// A lookup's result is the share of texels whose comparison "reference func texel" holds. The
// reference is r / q clamped to [0, 1]; it is compared with the texel's value, an integer over the
// largest one, as real numbers: nothing is rounded to the buffer's format. Float32 on the way to a
// texel, each operation rounded once, in the order of depth_lookup.cpp.
#pragma once

#include <cstdint>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "raster/buffers.h"
#include "raster/state.h"
#include "raster/texture.h"

namespace gnomon::raster {

struct DepthLookup {
  /// Borrowed. What the frame has drawn into it before is seen. Not the drawing pass's own target.
  const DepthBuffer* map = nullptr;
  /// Takes a fragment's position to (s, t, r, q); s / q and t / q from 0 to 1 span the map, r / q
  /// is the reference. Of a light: from world space; of a flat colour: from the mesh's own space.
  glm::mat4 map_from_position{1.0f};
  CompareFunc func = CompareFunc::less_equal;
  /// nearest: the one texel; linear: the four nearest texels' comparisons, weighted bilinearly.
  Filter filter = Filter::nearest;
  /// Depth of texels outside the map (GL_CLAMP_TO_BORDER); absent: those on its edge go on
  /// (GL_CLAMP_TO_EDGE).
  std::optional<float> border = 1.0f;
  bool operator==(const DepthLookup&) const = default;
};

/// The share, in [0, 1], of comparisons that hold at a position. A coordinate that is not a number
/// reads as 0, one out of a texel index's range as that range's end.
float compare_depth(const DepthLookup& lookup, const glm::vec4& position);

}  // namespace gnomon::raster
