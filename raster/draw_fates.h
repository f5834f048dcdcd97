// What became of a draw's fragments, pixel by pixel: how many failed which test, and where the
// stencil was counted up and down.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/frame.h"

namespace gnomon::raster {

/// Counts of fragments, row after row from the bottom row; they stop at 65535.
struct DrawFates {
  int width = 0, height = 0;
  std::vector<std::uint16_t> stencil_failed, depth_failed, passed;
  /// Fragments whose outcome asked for incr or incr_wrap; for decr or decr_wrap. Saturated and
  /// masked operations are among them.
  std::vector<std::uint16_t> raised, lowered;

  DrawFates(int width_px, int height_px);
};

/// Adds the fates of one command's fragments; nothing for a clear or a blit. The targets are read
/// and not written.
/// Preconditions: the command's targets, and the depth buffers that it looks up, hold what they
/// held before it; `fates` has their size.
void add_fates(const Command& command, const Targets& targets, DrawFates& fates);

}  // namespace gnomon::raster
