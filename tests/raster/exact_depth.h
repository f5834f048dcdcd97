// What the depth of a pixel is, in exact rational arithmetic: the oracle of depth accuracy. Two
// planes are measured against:
// - the snapped one: through the vertices after clipping and the snap of docs/semantics.md, which
//   is the plane that raster promises;
// - the unrounded one: through the window positions that OpenGL's formulas give for the float32
//   clip coordinates, if nothing is rounded on the way. Clipping does not move it.
// Polygon offset is part of both: factor * max(|dz/dx|, |dz/dy|) of the plane itself, exactly, plus
// `units` depth units.
//
// Invariant: no operation rounds and none overflows unseen; one that would leave 128 bits throws.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec4.hpp>

#include "raster/depth_plane.h"
#include "raster/state.h"

namespace gnomon::exact_depth {

using raster::Int128;

/// What of a draw and its target decides depth. Preconditions: factor and units of the offset are
/// multiples of 1/4.
struct View {
  int width = 0, height = 0;
  raster::DepthFormat format = raster::DepthFormat::d24;
  raster::DepthRange range;
  bool clamp = false;
  std::optional<raster::PolygonOffset> offset;
};

/// Depth at the centre of pixel (x, y), in depth units: (origin + x step_x + y step_y) / one, then
/// clamped to [low, high] units.
struct Plane {
  Int128 origin = 0, step_x = 0, step_y = 0, one = 1;
  Int128 low = 0, high = 0;

  Int128 at(int x, int y) const { return origin + x * step_x + y * step_y; }
};

/// Pixels first <= x < end.
struct Span {
  int first = 0, end = 0;
};

/// A triangle after the snap, counter-clockwise, with its plane. A clipped triangle is several.
class Piece {
 public:
  /// Preconditions: the vertices' area is positive.
  Piece(const std::array<raster::SnappedVertex, 3>& vertices, const View& view);

  const Plane& plane() const { return plane_; }
  /// The rows that its pixels lie in, first <= y < end.
  Span rows() const { return rows_; }
  /// The pixels of row y whose centres it covers; left and bottom edges belong to it.
  Span covered(int y) const;

 private:
  std::array<raster::SnappedVertex, 3> vertices_;
  Plane plane_;
  Span rows_;
};

/// The pieces of a triangle in the order in which they are drawn, those without area left out.
/// Clipping is raster's own (raster/clip.h): what is measured begins at the snap.
std::vector<Piece> snapped_pieces(const std::array<glm::vec4, 3>& clip, const View& view);

/// The plane through the unrounded window positions; nothing if the triangle is seen edge-on.
/// Preconditions: the depth range is [0, 1].
std::optional<Plane> unrounded_plane(const std::array<glm::vec4, 3>& clip, const View& view);

/// How far stored depths are from exact ones, in depth units.
struct Errors {
  std::uint64_t pixels = 0;
  /// Pixels that are more than one unit off.
  std::uint64_t beyond_one = 0;
  /// Pixels whose exact depth the clamp moved. They count for all but the mean, which they would
  /// flatter.
  std::uint64_t clamped = 0;
  double largest = 0.0, unclamped_sum = 0.0;

  /// `exact` is plane.at() of the pixel.
  void add(std::uint32_t stored, Int128 exact, const Plane& plane);
  void add(const Errors& other);
  double mean() const {
    return pixels > clamped ? unclamped_sum / static_cast<double>(pixels - clamped) : 0.0;
  }
};

}  // namespace gnomon::exact_depth
