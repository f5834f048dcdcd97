// A plane of values, one a pixel, stored tile by tile: tiles of 64x64 pixels, each cut in blocks of
// 8x8. Window coordinates as in OpenGL: (0, 0) is the bottom left pixel, y grows upwards.
// Invariant: storage is padded to whole tiles; padding is never part of a result.
#pragma once

#include <cstddef>
#include <vector>

#include "raster/check.h"

namespace gnomon::raster {

inline constexpr int kTileSize = 64;
inline constexpr int kBlockSize = 8;
inline constexpr int kBlocksPerTileRow = kTileSize / kBlockSize;
inline constexpr int kBlocksPerTile = kBlocksPerTileRow * kBlocksPerTileRow;
inline constexpr int kPixelsPerBlock = kBlockSize * kBlockSize;
inline constexpr int kPixelsPerTile = kTileSize * kTileSize;
/// Where block number `block` of a tile begins, in pixels of the tile.
constexpr int block_x(std::size_t block) {
  return static_cast<int>(block) % kBlocksPerTileRow * kBlockSize;
}
constexpr int block_y(std::size_t block) {
  return static_cast<int>(block) / kBlocksPerTileRow * kBlockSize;
}
/// Largest width and height of a target in pixels.
inline constexpr int kMaxTargetSize = 16384;

/// A width x height plane of T. Value-initialised.
template <class T>
class TiledPlane {
 public:
  TiledPlane() = default;
  TiledPlane(int width, int height) : width_(width), height_(height) {
    require(width >= 1 && height >= 1 && width <= kMaxTargetSize && height <= kMaxTargetSize,
            "a buffer is 1 to 16384 pixels wide and high");
    tiles_x_ = (width + kTileSize - 1) / kTileSize;
    tiles_y_ = (height + kTileSize - 1) / kTileSize;
    values_.resize(static_cast<std::size_t>(tiles_x_) * tiles_y_ * kPixelsPerTile);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int tiles_x() const { return tiles_x_; }
  int tiles_y() const { return tiles_y_; }

  T& at(int x, int y) { return values_[index(x, y)]; }
  const T& at(int x, int y) const { return values_[index(x, y)]; }

  /// The kPixelsPerTile values of one tile, block after block, each block row after row from its
  /// bottom row.
  T* tile(int tile_x, int tile_y) { return values_.data() + tile_offset(tile_x, tile_y); }
  const T* tile(int tile_x, int tile_y) const {
    return values_.data() + tile_offset(tile_x, tile_y);
  }

 private:
  std::size_t tile_offset(int tile_x, int tile_y) const {
    return (static_cast<std::size_t>(tile_y) * tiles_x_ + tile_x) * kPixelsPerTile;
  }
  std::size_t index(int x, int y) const {
    require(x >= 0 && y >= 0 && x < width_ && y < height_, "a pixel lies inside its buffer");
    const int in_x = x % kTileSize, in_y = y % kTileSize;
    const int block = (in_y / kBlockSize) * kBlocksPerTileRow + in_x / kBlockSize;
    return tile_offset(x / kTileSize, y / kTileSize) +
           static_cast<std::size_t>(block * kPixelsPerBlock + (in_y % kBlockSize) * kBlockSize +
                                    in_x % kBlockSize);
  }

  int width_ = 0, height_ = 0, tiles_x_ = 0, tiles_y_ = 0;
  std::vector<T> values_;
};

}  // namespace gnomon::raster
