#include "raster/depth_decision.h"

#include <algorithm>

namespace gnomon::raster {

namespace {

/// A plane's value and slopes as signed numbers.
struct SignedPlane {
  explicit SignedPlane(const TileDepth& plane)
      : base(static_cast<std::int64_t>(plane.base)),
        dx(static_cast<std::int64_t>(plane.step_x)),
        dy(static_cast<std::int64_t>(plane.step_y)),
        bits(plane.fraction_bits) {}

  std::int64_t base, dx, dy;
  int bits;

  /// Sums over a tile neither overflow nor leave 32 bits of depth units.
  bool is_tame() const {
    constexpr std::int64_t kLimit = std::int64_t{1} << 27;
    const auto within = [](std::int64_t value, std::int64_t limit) {
      return value > -limit && value < limit;
    };
    return within(base, kLimit << bits) && within(dx, (kLimit << bits) / kTileSize) &&
           within(dy, (kLimit << bits) / kTileSize);
  }
  std::int32_t down(std::int64_t value) const { return static_cast<std::int32_t>(value >> bits); }
  std::int32_t up(std::int64_t value) const { return static_cast<std::int32_t>(-(-value >> bits)); }
};

}  // namespace

DepthDecision::DepthDecision(CompareFunc func) {
  switch (func) {
    case CompareFunc::less:
      above_slack = 1;
      below = DepthOutcome::passes;
      above = DepthOutcome::fails;
      break;
    case CompareFunc::less_equal:
      below_slack = 1;
      below = DepthOutcome::passes;
      above = DepthOutcome::fails;
      break;
    case CompareFunc::greater:
      below_slack = 1;
      below = DepthOutcome::fails;
      above = DepthOutcome::passes;
      break;
    case CompareFunc::greater_equal:
      above_slack = 1;
      below = DepthOutcome::fails;
      above = DepthOutcome::passes;
      break;
    case CompareFunc::equal:
      below = above = DepthOutcome::fails;
      break;
    case CompareFunc::not_equal:
      below = above = DepthOutcome::passes;
      break;
    case CompareFunc::never:
    case CompareFunc::always:
      break;
  }
}

void DepthDecision::settle(const DecidedBlocks& decided, TestedBlocks& tested) const {
  (below == DepthOutcome::passes ? tested.depth_passes : tested.depth_fails) |= decided.below;
  (above == DepthOutcome::passes ? tested.depth_passes : tested.depth_fails) |= decided.above;
}

BlockDepths bound_plane(const TileDepth& plane, std::int32_t least, std::int32_t greatest) {
  BlockDepths depths{.low = least, .high = greatest, .least = least, .greatest = greatest};
  const SignedPlane p(plane);
  if (!p.is_tame()) return depths;
  constexpr int kSpan = kBlockSize - 1;
  const std::int64_t zero = 0;
  depths.low = p.down(p.base + (std::min(p.dx, zero) + std::min(p.dy, zero)) * kSpan);
  depths.low_step_x = p.down(p.dx * kBlockSize);
  depths.low_step_y = p.down(p.dy * kBlockSize);
  depths.high = p.up(p.base + (std::max(p.dx, zero) + std::max(p.dy, zero)) * kSpan);
  depths.high_step_x = p.up(p.dx * kBlockSize);
  depths.high_step_y = p.up(p.dy * kBlockSize);
  return depths;
}

DepthInterval bounds_in_box(const TileDepth& plane, const BlockDepths& depths,
                            const PixelBox& box) {
  const SignedPlane p(plane);
  if (!p.is_tame()) return {depths.least, depths.greatest};
  const auto [left, right] = std::minmax({box.x0 * p.dx, (box.x1 - 1) * p.dx});
  const auto [bottom, top] = std::minmax({box.y0 * p.dy, (box.y1 - 1) * p.dy});
  return {std::clamp(p.down(p.base + left + bottom), depths.least, depths.greatest),
          std::clamp(p.up(p.base + right + top), depths.least, depths.greatest)};
}

DepthInterval depths_of_block(const TileDepth& plane, std::size_t b) {
  // Rounding keeps the order, so the extremes are at corners; modulo 2^64 their values are right,
  // because corners that are covered have depths.
  const auto dx = static_cast<std::int64_t>(plane.step_x * (kBlockSize - 1));
  const auto dy = static_cast<std::int64_t>(plane.step_y * (kBlockSize - 1));
  const std::uint64_t corner = plane.base + static_cast<std::uint64_t>(block_x(b)) * plane.step_x +
                               static_cast<std::uint64_t>(block_y(b)) * plane.step_y;
  const auto depth = [&](std::int64_t along_x, std::int64_t along_y) {
    const std::uint64_t value =
        corner + static_cast<std::uint64_t>(along_x) + static_cast<std::uint64_t>(along_y);
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(
        static_cast<std::int64_t>(value) >> plane.fraction_bits, plane.low, plane.high));
  };
  const std::int64_t zero = 0;
  return {depth(std::min(dx, zero), std::min(dy, zero)),
          depth(std::max(dx, zero), std::max(dy, zero))};
}

}  // namespace gnomon::raster
