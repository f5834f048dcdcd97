// Which of a mesh's triangles reach the tiles: those that face the right way and whose box, inside
// the draw's, has a pixel; where it has at most 4x4, one whose centre is covered. And the pixels of
// those, and the depth planes of those that are small and not steep.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/pixel_box.h"

namespace gnomon::raster {

/// Triangles are looked at in batches of so many, a bit of a mask each.
inline constexpr std::size_t kTriangleBatch = 64;
using TriangleMask = std::uint64_t;

/// The vertices of a small triangle lie within so many pixels, or 1/256 pixels.
inline constexpr int kSmallPixels = 31, kSmallExtent = kSmallPixels * 256;
/// A small triangle is looked at pixel by pixel where its box has at most so many a side.
inline constexpr int kTinyBox = 4;
/// Pixels of a tiny triangle, bit 4 y + x from the first pixel of its box on.
using TinyPixels = std::uint16_t;

/// What all triangles of a draw share.
struct TriangleSelector {
  /// Snapped vertices (raster/project.h).
  const std::int32_t *x_fx = nullptr, *y_fx = nullptr;
  /// Null: no planes are wanted.
  const std::int64_t* z_fx = nullptr;
  /// Triangles that go counter-clockwise (clockwise) in the window are kept.
  bool keeps_ccw = true, keeps_cw = true;
  PixelBox box;
};

struct TriangleBatch {
  /// Those with a vertex that was not projected, of which nothing else is known; the others that
  /// are kept.
  TriangleMask clipped, kept;
  /// Of those kept: clockwise in the window; small.
  TriangleMask clockwise, small;
  /// Those whose plane is known; of the other ones it has to be found by make_depth_plane. Plain
  /// C++ finds none.
  TriangleMask planes;
  /// Of those kept: twice the signed area, and the pixels of the box.
  double area[kTriangleBatch];
  std::int32_t x0[kTriangleBatch], y0[kTriangleBatch], x1[kTriangleBatch], y1[kTriangleBatch];
  /// Of those kept: TinyPixels, which are some; 0 if it is not tiny.
  std::int32_t pixels[kTriangleBatch];
  /// Of those with a plane (raster/depth_plane.h): the slopes, and the base at the tile of pixel
  /// (x0, y0).
  std::int64_t step_x[kTriangleBatch], step_y[kTriangleBatch], base[kTriangleBatch];
};

/// Kernels::select_triangles in plain C++.
void select_triangles(const TriangleSelector& selector, const std::uint32_t* indices,
                      std::size_t count, TriangleBatch& out) noexcept;

}  // namespace gnomon::raster
