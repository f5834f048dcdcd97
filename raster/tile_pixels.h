// The pixels of a pass's targets inside one 64x64 tile while a job draws them: where they lie, what
// is known of their depths, and stencil counts of whole blocks that are not added yet.
// Invariant: a block's stencils are those that are stored plus its pending count, modulo 256.
#pragma once

#include <array>
#include <cstdint>

#include "raster/frame.h"
#include "raster/kernels.h"
#include "raster/tile_blocks.h"

namespace gnomon::raster {

class TilePixels {
 public:
  TilePixels(const Kernels& kernels, TileIndex tile) : kernels_(kernels), tile_(tile) {}
  TilePixels(const TilePixels&) = delete;
  TilePixels& operator=(const TilePixels&) = delete;
  ~TilePixels() { add_counts(); }

  const Kernels& kernels() const { return kernels_; }
  TileIndex tile() const { return tile_; }

  /// What follows goes to these buffers.
  void use(const Targets& targets);
  const Targets& targets() const { return targets_; }

  /// 64 blocks of 64 values; null if the target is absent.
  std::uint32_t* depth() const { return depth_.values; }
  std::uint8_t* stencil() const { return stencil_; }
  /// Precondition: there is a depth target.
  DepthRanges& ranges() const { return *depth_.ranges; }

  /// Makes the ranges of the blocks known.
  void know_ranges(BlockMask blocks);
  /// Makes the whole tile's range known.
  void know_whole_range();

  /// Counts `delta` in every pixel of the blocks.
  void count(BlockMask blocks, std::uint8_t delta);
  /// Adds what is pending: before stencils are read, or written otherwise than by counts.
  void add_counts();

 private:
  const Kernels& kernels_;
  const TileIndex tile_;
  Targets targets_;
  DepthTile depth_;
  std::uint8_t* stencil_ = nullptr;
  std::array<std::uint8_t, kBlocksPerTile> counts_{};
  bool pending_ = false;
};

}  // namespace gnomon::raster
