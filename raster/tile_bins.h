// Which of a chunk's triangles touch which tile.
// Invariant: a tile's list has every triangle that covers a pixel of it, in the chunk's order; it
// may have others that only come near.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/geometry.h"
#include "raster/tile_blocks.h"

namespace gnomon::raster {

class TileBins {
 public:
  /// Bins the triangles anew; memory is kept.
  void fill(std::span<const SetupTriangle> triangles);

  /// Numbers of the triangles that touch the tile.
  std::span<const std::uint32_t> of(TileIndex tile) const {
    const int x = tile.x - x0_, y = tile.y - y0_;
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return {};
    const std::uint32_t* const start =
        starts_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + x;
    return {numbers_.data() + start[0], start[1] - start[0]};
  }

 private:
  struct Touch {
    std::uint32_t tile, triangle;
  };

  /// Adds the tiles of a triangle that touches more than one.
  void walk(const SetupTriangle& triangle, std::uint32_t number);
  void add(int tile_x, int tile_y, std::uint32_t number);

  /// Tiles [x0, x0 + width) x [y0, y0 + height) are those that the chunk comes near.
  int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;
  std::vector<Touch> touches_;
  /// Of each tile the place of its first number, and one more.
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace gnomon::raster
