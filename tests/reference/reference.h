// The slow, obvious renderer that is the oracle of raster/: one loop a pixel over the whole target,
// every draw after the other; no tiles in the walk, no blocks, no masks, no incremental sums. It
// follows docs/semantics.md, not the fast code; of raster/ it uses only the frame's data, the
// colour of a fragment (shade) or a vertex (light_vertex) and the buffers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "raster/frame.h"

namespace gnomon::reference {

/// Fragments by where their way ended, of all draws of a frame together. A grid of tests asks
/// whether it got to each outcome at all.
struct Outcomes {
  std::uint64_t stencil_fail = 0, depth_fail = 0, pass = 0;
};

/// Effect: that of raster::execute, byte for byte.
Outcomes execute(const raster::Frame& frame,
                 std::size_t commands = std::numeric_limits<std::size_t>::max());

}  // namespace gnomon::reference
