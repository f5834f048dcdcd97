// Vertices from clip space to the window and the snap to 1/256 pixel: where floats end. Order of
// operations (docs/semantics.md): division by w and viewport in double; coordinates and depth
// rounded to nearest, ties to even.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/vec4.hpp>

#include "raster/clip.h"

namespace gnomon::raster {

/// Bound of a snapped coordinate: 65536 pixels, so that edge values stay below 2^53 and doubles
/// hold them exactly.
inline constexpr std::int32_t kMaxCoordinate = 1 << 24;

/// What all vertices of a draw share.
struct Projection {
  ClipVolume volume;
  /// window = (clip / w) * scale + middle; the window's depth is in [0, 1].
  double scale_x = 1.0, scale_y = 1.0, scale_depth = 1.0;
  double middle_x = 0.0, middle_y = 0.0, middle_depth = 0.0;
  /// Depth 1 in plane units (raster/depth_plane.h), and whole bounds that depths are clamped to.
  double one = 1.0, lowest = 0.0, highest = 1.0;
};

/// A vertex inside the clip volume, snapped: x and y in 1/256 pixel, z in plane units; and 1/w.
struct ProjectedVertex {
  std::int32_t x_fx = 0, y_fx = 0;
  std::int64_t z_fx = 0;
  double inverse_w = 1.0;
};

/// The x of a vertex that the clip volume does not hold; its other fields say nothing.
inline constexpr std::int32_t kClipped = std::numeric_limits<std::int32_t>::min();

/// Projected vertices, a plane a field.
struct ProjectedPlanes {
  std::int32_t *x_fx, *y_fx;
  std::int64_t* z_fx;
  double* inverse_w;
};

/// No coordinate is infinite or NaN.
bool finite(const glm::vec4& clip);

/// Precondition: a finite position with w > 0.
ProjectedVertex project(const glm::dvec4& clip, const Projection& projection);

/// Kernels::project in plain C++.
void project_vertices(const Projection& projection, const glm::vec4* clip, std::size_t count,
                      const ProjectedPlanes& out) noexcept;

}  // namespace gnomon::raster
