// Seeded triangles that are hard on depth, laid out so that each one's depths can be read back: the
// triangles of a batch do not overlap, so one frame measures many. Kinds differ in size, in shape
// and in what is cut. The same seed gives the same batch wherever the library's exp2 and log2 round
// alike; sizes are drawn from them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "exact_depth.h"
#include "raster/execute.h"

namespace gnomon::depth_batches {

enum class Kind : std::uint8_t {
  /// A few pixels, on the 1/256 pixel grid; depth may cross the whole range within a pixel.
  tiny,
  /// Up to 32 pixels, on the grid.
  ordinary,
  /// 1/256 to 4 pixels wide and about 1000 long, lying or standing or leaning, on the grid.
  sliver,
  /// 8192 pixels wide, 1/256 to 2 pixels high, on the grid.
  huge,
  /// Up to 32 pixels, off the grid; the vertices' w from 1e-3 to 1e6.
  perspective,
  /// 8192 pixels wide and off the grid, w as before.
  huge_perspective,
  /// As perspective, but near and far planes cut.
  near_far,
  /// Vertices behind the eye or beyond the guard band; half of the batches with depth clamp.
  eye_plane
};

inline constexpr std::array<Kind, 8> kKinds{
    Kind::tiny,        Kind::ordinary,         Kind::sliver,   Kind::huge,
    Kind::perspective, Kind::huge_perspective, Kind::near_far, Kind::eye_plane};

std::string_view name(Kind kind);

struct Batch {
  exact_depth::View view;
  /// Clip coordinates, three a triangle.
  std::vector<glm::vec4> positions;
  /// Where a triangle may draw; empty: anywhere.
  std::vector<raster::Rect> scissors;

  std::size_t size() const { return positions.size() / 3; }
  std::array<glm::vec4, 3> triangle(std::size_t i) const {
    return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
  }
};

/// A batch of this seed. With an offset its factor lies in [-4, 4] and its units in [-100, 100],
/// both multiples of 1/4.
Batch make_batch(Kind kind, bool offset, std::uint32_t seed);

/// Records the batch: depth as drawn, whatever was there; the stencil counts a pixel's writes.
/// Preconditions: the targets have the view's size; the batch outlives the frame.
void record(const Batch& batch, raster::Frame& frame, const raster::Targets& targets);

/// Rows from the bottom one.
struct Drawn {
  std::vector<std::uint32_t> depth;
  std::vector<std::uint8_t> stencil;
};

Drawn draw(const Batch& batch, const raster::ExecuteOptions& options);

/// A batch's errors against both planes, at the pixels that the renderer wrote and that the snapped
/// triangle covers.
struct Measured {
  std::uint64_t triangles = 0;
  /// Those that cover a pixel.
  std::uint64_t visible = 0;
  exact_depth::Errors snapped, unrounded;
  /// Pixels that only one of the renderer and the snapped triangle covers.
  std::uint64_t coverage_differs = 0;

  void add(const Measured& other);
};

enum class Planes : std::uint8_t { snapped, both };

Measured measure(const Batch& batch, const Drawn& drawn, Planes planes);

}  // namespace gnomon::depth_batches
