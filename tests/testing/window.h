// Shapes given in pixels and depths, for tests whose answer is counted by hand: no camera, no
// matrix. They cover exactly the pixels of their rectangle. A shape belongs to the pass that was
// begun last, whose targets' size it needs, and its memory to the frame.
//
// Misuse: no pass, a viewport or a depth range of the state's own, a depth outside [0, 1].
#pragma once

#include "raster/frame.h"

namespace gnomon::testing {

/// A draw of a quad at one depth, its front (counter-clockwise) towards the eye; white.
raster::Draw window_quad(raster::Frame& frame, const raster::State& state,
                         const raster::Rect& pixels, float depth);

/// A draw of a closed box as one looks straight into it: a quad with its front towards the eye at
/// near_depth and one with its back at far_depth. (The four other faces are seen edge-on.)
raster::Draw window_box(raster::Frame& frame, const raster::State& state,
                        const raster::Rect& pixels, float near_depth, float far_depth);

}  // namespace gnomon::testing
