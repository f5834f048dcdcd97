// A triangle's depth as a plane over its snapped vertices, exact where it is set up and within half
// a unit where it is used.
//
// Unit of the plane: 2^-f depth units, f = 8 for D24 and 16 for D16 (so 24.8 and 16.16 fixed
// point). At a 64x64 tile the plane is
//   value(x, y) = base + x * step_x + y * step_y,   x, y = 0..63 from the tile's bottom left pixel,
// with base the exactly rounded rational value at that pixel's centre (polygon offset included) and
// the steps exactly rounded rational slopes a pixel. The stored depth is floor((value + half a
// unit) / 2^f). Error: base 2^-9, steps 63 (2^-9 + 2^-9), offset 2^-9, together 1/4 of a unit for
// D24 before the last rounding, so the depth is within one unit of the exactly rounded one. A
// covered pixel's exact value lies between the vertices', so with vertices in [0, 2^(32) - 2^f]
// value + half a unit stays in 32 bits, and modular 32-bit sums are right whatever the slopes are.
// Other triangles (depth clamp, offset) use 64 bits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "raster/buffers.h"
#include "raster/state.h"
#include "raster/wide.h"

namespace gnomon::raster {

/// A vertex after the snap: x and y in 1/256 pixel, z in 2^-f depth units.
struct SnappedVertex {
  std::int32_t x_fx = 0, y_fx = 0;
  std::int64_t z_fx = 0;
};

/// Bits of fraction of a depth plane's unit.
constexpr int depth_fraction_bits(DepthFormat format) {
  return format == DepthFormat::d24 ? 8 : 16;
}

/// Vertex depths outside are clamped to this magnitude (2^28 depth ranges away).
inline constexpr std::int64_t kMaxVertexDepth = std::int64_t{1} << 60;

/// How far a stored value, half a unit added, can lie from the exact one, in plane units: the
/// base's, the steps' and the offset's rounding at a tile's far corner.
inline constexpr std::int64_t kPlaneError = 65;

struct DepthPlane {
  /// Slopes a pixel, exactly rounded, modulo 2^64.
  std::uint64_t step_x = 0, step_y = 0;
  /// Polygon offset of the exact slopes, to nearest; computed in double, so up to a unit of the
  /// plane off where it is 2^50 or more, 2^18 depth ranges away.
  std::int64_t offset = 0;
  /// Every covered pixel's value fits 32 bits and needs no clamp.
  bool narrow = true;
};

/// Preconditions: area is the vertices' doubled signed area and positive; |z_fx| <=
/// kMaxVertexDepth. low and high are the bounds of depth in depth units that fragments are clamped
/// to.
DepthPlane make_depth_plane(const std::array<SnappedVertex, 3>& vertices, std::int64_t area,
                            const std::optional<PolygonOffset>& offset, DepthFormat format,
                            std::uint32_t low, std::uint32_t high);

/// Every covered pixel's value fits 32 bits and needs no clamp: the vertices' depths,
/// `offset` added, lie between those of low and high.
bool is_narrow(const std::array<SnappedVertex, 3>& vertices, std::int64_t offset,
               DepthFormat format, std::uint32_t low, std::uint32_t high);

/// base of the tile whose bottom left pixel is (x_px, y_px), modulo 2^64. `area` is positive; the
/// polygon offset was added to the vertices.
std::uint64_t depth_base_at(const std::array<SnappedVertex, 3>& vertices, std::int64_t area,
                            int x_px, int y_px);

}  // namespace gnomon::raster
