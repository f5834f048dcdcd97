// The least and greatest stored depth of each 8x8 block of the tile that is being drawn, so that a
// triangle can be found to pass or fail a block's depth test as a whole (hierarchical Z: Greene,
// Kass and Miller 1993). Lives as long as a tile's job; nothing of it outlasts the tile.
// Invariant: a range that is known encloses every depth that the block holds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "raster/buffers.h"
#include "raster/kernels.h"
#include "raster/tiled_plane.h"

namespace gnomon::raster {

struct DepthRangeUnits {
  std::uint32_t least = 0, greatest = 0;
};

class BlockRanges {
 public:
  /// Ranges of another buffer are forgotten.
  void use(const DepthBuffer* buffer) {
    if (buffer != buffer_) known_ = 0;
    buffer_ = buffer;
  }

  /// The range of block number `block`, whose depths lie at `depth`.
  const DepthRangeUnits& of(std::size_t block, const std::uint32_t* depth, const Kernels& kernels) {
    if ((known_ >> block & 1) == 0) {
      kernels.depth_range(depth, ranges_[block].least, ranges_[block].greatest);
      known_ |= std::uint64_t{1} << block;
    }
    return ranges_[block];
  }

  /// The block's depths have changed.
  void forget(std::size_t block) { known_ &= ~(std::uint64_t{1} << block); }
  void forget_all() { known_ = 0; }

 private:
  const DepthBuffer* buffer_ = nullptr;
  std::uint64_t known_ = 0;
  std::array<DepthRangeUnits, kBlocksPerTile> ranges_;
};

}  // namespace gnomon::raster
