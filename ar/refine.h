// Sub-pixel corners of a tag: lines fitted to its four edges in linear light, along undistorted
// straight lines where the lens is known, and met at the corners.
#pragma once

#include "ar/camera.h"
#include "ar/response.h"
#include "ar/tags.h"

namespace gnomon::ar {

/// What a family's square looks like around the edge that is fitted.
struct SquareLook {
  /// Modules across the square; the edge has one module of black on one side and of white on the
  /// other.
  int modules = 8;
  /// White inside and black outside (AprilTag's reversed_border).
  bool white_inside = false;
};

/// Better corners for a detected square, or `rough` itself where an edge has too few usable samples
/// or the result strays by more than a module.
/// Cost: about 50 samples per pixel of circumference.
TagCorners refine_corners(const LightPlane& light, const TagCorners& rough, const SquareLook& look,
                          const Lens* lens = nullptr);

}  // namespace gnomon::ar
