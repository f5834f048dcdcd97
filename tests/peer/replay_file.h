// A saved frame (raster/frame_format.h) on both rasterizers, pass by pass.
//
// OpenGL's buffers stand for the targets of the last pass that has colour, depth and stencil;
// passes that share none of these (a shadow map's) run on gnomon alone, and a look-up hands their
// result over.
#pragma once

#include <cstddef>
#include <string>

#include "raster/frame_format.h"

namespace gnomon::peer {

struct FrameReplay {
  /// A line a pass: what differs, and why (explain.h).
  std::string text;
  std::size_t differing = 0, unexplained = 0;
  bool is_llvmpipe = false;
};

/// Errors: std::runtime_error for a frame that has no such pass or whose depth is not D24.
FrameReplay replay_frame(const raster::RecordedFrame& recorded);

}  // namespace gnomon::peer
