// The least and greatest stored depth of each 8x8 block of a tile, and of the whole tile, so that a
// triangle can be found to pass or fail the depth test as a whole (hierarchical Z: Greene, Kass and
// Miller 1993). They stay with the buffer from frame to frame.
// Invariant: a range encloses every depth that its block holds, known or not.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "raster/tiled_plane.h"

namespace gnomon::raster {

/// Ranges of a tile's 64 blocks (bit 8 y + x is block (x, y)), in depth units.
struct DepthRanges {
  static constexpr std::uint32_t kGreatest = 0xffffff;

  alignas(64) std::array<std::uint32_t, kBlocksPerTile> least;
  alignas(64) std::array<std::uint32_t, kBlocksPerTile> greatest;
  /// Blocks whose range is exact; the others' is all that a depth can be.
  std::uint64_t known = 0;
  /// The whole tile's range, if it is known.
  bool whole_known = false;
  std::uint32_t whole_least = 0, whole_greatest = kGreatest;
  /// DepthBuffer's version that this belongs to.
  std::uint64_t version = 0;

  DepthRanges() { forget_all(); }

  void forget_all() {
    least.fill(0);
    greatest.fill(kGreatest);
    known = 0;
    whole_known = false;
  }
  void forget(std::size_t block) {
    least[block] = 0;
    greatest[block] = kGreatest;
    known &= ~(std::uint64_t{1} << block);
    whole_known = false;
  }
  void set(std::size_t block, std::uint32_t low, std::uint32_t high) {
    least[block] = low;
    greatest[block] = high;
    known |= std::uint64_t{1} << block;
    whole_known = false;
  }
};

struct DepthTile {
  /// kPixelsPerTile values, block after block.
  std::uint32_t* values = nullptr;
  DepthRanges* ranges = nullptr;
};

}  // namespace gnomon::raster
