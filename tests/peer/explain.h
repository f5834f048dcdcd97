// Why two rasterizers leave different bytes at a pixel, when each keeps the rules. Two things are
// free: how a vertex is rounded on its way to 1/256 pixel (and where a clipped edge is cut), and
// how a depth plane is evaluated. So a pixel may differ
// - by coverage: its centre lies within kEdgeReach of an edge of a triangle of the pass;
// - by a depth tie: a triangle of the pass covers it with a depth that is within the tolerance of
//   the depth that it is compared with;
// - by an earlier pass: the stencil differed there already and was not cleared, or the depth that
//   a triangle is compared with did, and the triangle lies between the two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raster/frame.h"
#include "replay.h"

namespace gnomon::peer {

/// Pixels. A vertex moves by up to 1/256 pixel along x and y when it snaps the other way, and a
/// clipped one, which only one side has, by its own rounding besides: an edge moves by less than
/// the diagonal of a 2/256 pixel square, rounded up.
inline constexpr double kEdgeReach = 3.0 / 256.0;

/// Depth units by which two evaluations of one plane may differ at one point: each is within one.
inline constexpr double kDepthTie = 2.0;

/// Both sides' buffers before and after a pass.
struct Step {
  const Buffers &before, &before_gl, &after, &after_gl;
  int width, height;
};

struct StencilCauses {
  /// coverage, depth_tie, earlier and unexplained add up to differing.
  std::size_t differing = 0, coverage = 0, depth_tie = 0, earlier = 0, unexplained = 0;
  /// Of depth_tie: those whose depths are more than kDepthTie apart, explained by a vertex of a
  /// steep triangle that moved by 1/256 pixel.
  std::size_t steep = 0;
  /// The largest distance to an edge of a pixel counted under coverage, in pixels.
  double farthest_edge_px = 0.0;
};

struct DepthCauses {
  /// Any difference; more than kDepthTie; of those near an edge, on a steep triangle, none of
  /// these.
  std::size_t differing = 0, large = 0, coverage = 0, steep = 0, earlier = 0, unexplained = 0;
  /// Largest difference of a pixel that is not counted under coverage or earlier.
  std::uint32_t largest_on_surface = 0;
};

/// Pixels of edges of the pass's triangles inside the picture, all together; a shared edge counts
/// for each of its triangles. Only draws that can change stencil or depth.
double visible_edges_px(const raster::Pass& pass, int width, int height);

StencilCauses explain_stencil(const raster::Pass& pass, const Step& step);
DepthCauses explain_depth(const raster::Pass& pass, const Step& step);

}  // namespace gnomon::peer
