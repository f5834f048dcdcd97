// The 8x8 blocks of a 64x64 tile: where they lie and which of their pixels a box has.
#pragma once

#include <algorithm>
#include <cstddef>

#include "raster/geometry.h"
#include "raster/kernels.h"
#include "raster/tiled_plane.h"

namespace gnomon::raster {

/// A tile's coordinates, in tiles.
struct TileIndex {
  int x = 0, y = 0;
};

inline PixelBox tile_box(TileIndex tile) {
  return {tile.x * kTileSize, tile.y * kTileSize, (tile.x + 1) * kTileSize,
          (tile.y + 1) * kTileSize};
}

/// Pixels of the block at (x0, y0) that lie inside a box.
inline PixelMask box_mask(const PixelBox& box, int x0, int y0) {
  const int left = std::clamp(box.x0 - x0, 0, kBlockSize),
            right = std::clamp(box.x1 - x0, 0, kBlockSize);
  const int bottom = std::clamp(box.y0 - y0, 0, kBlockSize),
            top = std::clamp(box.y1 - y0, 0, kBlockSize);
  if (left >= right || bottom >= top) return 0;
  const PixelMask row = ((PixelMask{1} << (right - left)) - 1) << left;
  PixelMask mask = 0;
  for (int y = bottom; y < top; ++y) mask |= row << (y * kBlockSize);
  return mask;
}

/// Calls body(number of the block in the tile, mask) for each 8x8 block that has some of the
/// pixels, which begin at pixel (x, y) of the tile and do not leave it.
template <class Body>
void for_each_block(TinyPixels pixels, int x, int y, Body body) {
  const std::uint64_t p = pixels;
  const PixelMask rows = (p & 0xf) | (p & 0xf0) << 4 | (p & 0xf00) << 8 | (p & 0xf000) << 12;
  // Unsigned, because the remainder of a number that may be negative takes more.
  const unsigned ux = static_cast<unsigned>(x), uy = static_cast<unsigned>(y);
  const int in_x = static_cast<int>(ux % kBlockSize), in_y = static_cast<int>(uy % kBlockSize);
  const std::size_t block = uy / kBlockSize * kBlocksPerTileRow + ux / kBlockSize;
  const auto column = [&](std::size_t b, PixelMask mask) {
    if (const PixelMask lower = mask << kBlockSize * in_y) body(b, lower);
    if (in_y > kTinyBox)
      if (const PixelMask upper = mask >> kBlockSize * (kBlockSize - in_y))
        body(b + kBlocksPerTileRow, upper);
  };
  if (in_x <= kBlockSize - kTinyBox) {
    column(block, rows << in_x);
    return;
  }
  constexpr PixelMask kFirstColumn = 0x0101010101010101u;
  const PixelMask at_left = kFirstColumn * ((0xffu << in_x) & 0xffu);
  column(block, rows << in_x & at_left);
  column(block + 1, rows >> (kBlockSize - in_x) & ~at_left);
}

/// Calls body(number of the block in the tile, mask of the box's pixels) for each 8x8 block that a
/// box touches.
template <class Body>
void for_each_block(const PixelBox& box, TileIndex tile, Body body) {
  const PixelBox inside = intersect(box, tile_box(tile));
  if (inside.empty()) return;
  const int x0 = tile.x * kTileSize, y0 = tile.y * kTileSize;
  for (int by = (inside.y0 - y0) / kBlockSize; by <= (inside.y1 - 1 - y0) / kBlockSize; ++by)
    for (int bx = (inside.x0 - x0) / kBlockSize; bx <= (inside.x1 - 1 - x0) / kBlockSize; ++bx) {
      const auto block = static_cast<std::size_t>(by * kBlocksPerTileRow + bx);
      body(block, box_mask(inside, x0 + block_x(block), y0 + block_y(block)));
    }
}

}  // namespace gnomon::raster
