// Why two rasterizers that start a draw from the same bytes may leave different ones, pixel by
// pixel, by simulation: every triangle of the draw is given the pixel as llvmpipe may have given it
// (llvmpipe_model.h: covered or not where an edge is near, a depth within bounds), the fragments
// run OpenGL's tests, and OpenGL's bytes must be among the outcomes. Nothing else is admitted: a
// difference is explained when one such history leads to the very stencil, depth and colour that
// were read back, and gnomon's own coverage and depths are as far from it as the snap may bring
// them and no farther.
//
// Its class is what in that history differs from gnomon's own:
// - snap: a triangle covers the pixel in one of the two only, an edge being so near to its centre
//   that a vertex snapped to the next 1/256 pixel decides;
// - cut: the same, an edge being so near only with what float32 does to the corners of a triangle
//   that llvmpipe clips and gnomon does not (documented choice: the guard band);
// - tie: a depth comparison went the other way, the two depths being within the planes' bounds;
// - plane: the same fragments passed, but a stored depth is another evaluation of the same plane,
//   at most two units away;
// - steep: the same, farther away: gnomon's plane goes through the snapped vertices, llvmpipe's
//   through those before the snap and in float32 (documented choice);
// - blend: the same fragments passed, but llvmpipe's 8-bit products are rounded one by one
//   (documented choice).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "compare.h"
#include "raster/frame.h"

namespace gnomon::peer {

/// Values that differ, by class.
struct DrawCauses {
  Differing snap, cut, tie, plane, steep, blend, unexplained;
  DrawCauses& operator+=(const DrawCauses& other);
};

/// Whose history it is. softpipe has llvmpipe's clipper, rounds depths down and blends as gnomon
/// does; its fill rule needs no more than a snap, because ties lie on an edge.
enum class Driver : std::uint8_t { llvmpipe, softpipe };

/// Buffers before the draw, the same for both, and after it.
struct DrawStep {
  const Buffers &before, &after, &after_gl;
  int width, height;
  Driver driver;
};

struct DrawExplanation {
  DrawCauses causes;
  /// Index of the first pixel that nothing explains.
  std::optional<std::size_t> unexplained_pixel;
};

/// Preconditions: targets with colour (RGBA8), depth (D24) and stencil; Flat shading of one colour.
DrawExplanation explain_draw(const raster::Draw& draw, const raster::Targets& targets,
                             const DrawStep& step);

}  // namespace gnomon::peer
