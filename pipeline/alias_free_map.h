// Alias-free shadow maps: exact hard shadows without a size and without a bias (Johnson, Lee, Burns
// and Mark 2005, the irregular Z-buffer; Aila and Laine 2004). Not the light's view is sampled on a
// grid, but exactly the points that the camera sees (pipeline/visible_points.h): each is tested
// against the casters' triangles that cover its cell of the light's view (pipeline/light_grid.h).
//
// The convention is that of the volumes and of RayReference: a triangle hides a point if it crosses
// the line from the point to the light, from either side; the visible side of a caster's surface
// that is turned from the light is hidden by the surface itself; a triangle whose plane the light
// lies in hides nothing but itself. Of an object in whose place another mesh casts, that mesh's
// triangles hide, and the visible surface hides nothing.
//
// Whether the line passes inside a triangle's edges is decided exactly (pipeline/plane_side.h), so
// it slips through no seam. Whether the triangle is in front of the point is decided up to what
// rounding can have moved point and corners (alias_free_map.cpp): nearer than that, nanometres in a
// room, a triangle hides nothing. So a surface never shadows itself or what is coplanar with it,
// and no number is tuned.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pipeline/casters.h"
#include "pipeline/displaced_caster.h"
#include "pipeline/light_grid.h"
#include "pipeline/placed_object.h"
#include "pipeline/visible_points.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// Memory of the alias-free maps, kept between frames. Not for use by several threads at once.
struct AliasFreeMemory {
  PointFinder finder;
  LightGrid grid;
  /// Of what casts in the place of an object, which the light may have moved; one an object.
  std::vector<WorldCorners> shadow_corners;
  MovedCaster moved;
  /// Of the points to be tested: their pixels, and where they are.
  std::vector<std::uint32_t> pixels;
  std::vector<glm::dvec3> points;
  /// The same in the grid's order.
  struct TestPoint {
    glm::dvec3 at;
    double error_m;
  };
  std::vector<TestPoint> sorted;
  std::vector<std::atomic<std::uint8_t>> sorted_hidden;
  /// 1 or 0 a pixel, row after row from the bottom row.
  std::vector<std::uint8_t> hidden;
};

/// For each pixel of memory.finder's points: 1 where a caster hides the light from a point of an
/// object that receives shadows. The bytes are the same for every number of threads. Valid until
/// the next call. `light` is taken as a point or direction: see light_samples.h. Preconditions:
/// memory.finder has found the points of these objects and this camera.
std::span<const std::uint8_t> find_hidden(std::span<const PlacedObject> objects,
                                          const Casters& casters, const Camera& camera,
                                          const Light& light, int threads, AliasFreeMemory& memory);

/// Records a draw that increments the stencil at exactly the pixels of a pass of that size that are
/// 1: rows of hidden pixels as rectangles along pixel edges. So the mask is a part of the frame,
/// which can be saved and replayed, and a lookup's rounding cannot miss a pixel.
/// Precondition: width * height bytes, row after row from the bottom row.
void stencil_hidden(raster::Frame& frame, std::span<const std::uint8_t> hidden, int width,
                    int height, std::string label);

}  // namespace gnomon::pipeline
