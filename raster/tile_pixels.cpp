#include "raster/tile_pixels.h"

#include <algorithm>

namespace gnomon::raster {

void TilePixels::use(const Targets& targets) {
  if (targets == targets_) return;
  add_counts();
  targets_ = targets;
  depth_ = targets.depth ? targets.depth->tile(tile_.x, tile_.y) : DepthTile{};
  stencil_ = targets.stencil ? targets.stencil->plane().tile(tile_.x, tile_.y) : nullptr;
}

void TilePixels::know_ranges(BlockMask blocks) {
  DepthRanges& ranges = *depth_.ranges;
  for_each_block_of(blocks & ~ranges.known, [&](std::size_t b) {
    std::uint32_t least = 0, greatest = 0;
    kernels_.depth_range(depth_.values + b * kPixelsPerBlock, least, greatest);
    ranges.set(b, least, greatest);
  });
}

void TilePixels::know_whole_range() {
  DepthRanges& ranges = *depth_.ranges;
  if (ranges.whole_known) return;
  know_ranges(kAllBlocks);
  ranges.whole_least = *std::min_element(ranges.least.begin(), ranges.least.end());
  ranges.whole_greatest = *std::max_element(ranges.greatest.begin(), ranges.greatest.end());
  ranges.whole_known = true;
}

void TilePixels::count(BlockMask blocks, std::uint8_t delta) {
  pending_ = true;
  if (blocks == kAllBlocks) {
    for (std::uint8_t& count : counts_) count = static_cast<std::uint8_t>(count + delta);
    return;
  }
  for_each_block_of(
      blocks, [&](std::size_t b) { counts_[b] = static_cast<std::uint8_t>(counts_[b] + delta); });
}

void TilePixels::add_counts() {
  if (!pending_) return;
  kernels_.add_to_blocks(counts_.data(), stencil_);
  counts_.fill(0);
  pending_ = false;
}

}  // namespace gnomon::raster
