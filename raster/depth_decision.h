// When a depth test can be decided for many fragments at once: bounds of a triangle's depths
// against the range of those that are stored (raster/depth_ranges.h).
#pragma once

#include <cstdint>

#include "raster/geometry.h"
#include "raster/kernels.h"

namespace gnomon::raster {

enum class DepthOutcome : std::uint8_t { passes, fails, open };

/// How a compare function that is neither always nor never judges fragments that all lie below, or
/// all above, what is stored; with a slack of 1 equal depths count as below (above) too.
struct DepthDecision {
  explicit DepthDecision(CompareFunc func);

  std::int32_t below_slack = 0, above_slack = 0;
  DepthOutcome below = DepthOutcome::open, above = DepthOutcome::open;

  /// Fragments between least and greatest against stored depths between the others.
  DepthOutcome of(std::int32_t least, std::int32_t greatest, std::uint32_t stored_least,
                  std::uint32_t stored_greatest) const {
    if (greatest < static_cast<std::int32_t>(stored_least) + below_slack) return below;
    if (least > static_cast<std::int32_t>(stored_greatest) - above_slack) return above;
    return DepthOutcome::open;
  }
  /// Adds what Kernels::compare_ranges found with the slacks.
  void settle(const DecidedBlocks& decided, TestedBlocks& tested) const;
};

/// Bounds of a plane's depths block by block, between least and greatest everywhere. Where the
/// plane is too far from any depth, or too steep, these two are all there is.
BlockDepths bound_plane(const TileDepth& plane, std::int32_t least, std::int32_t greatest);

/// Bounds over a box in the tile's pixels, of the plane that `depths` came from.
DepthInterval bounds_in_box(const TileDepth& plane, const BlockDepths& depths, const PixelBox& box);

/// The least and greatest depth of the plane in block b, exactly, if all 64 pixels are covered.
DepthInterval depths_of_block(const TileDepth& plane, std::size_t b);

}  // namespace gnomon::raster
