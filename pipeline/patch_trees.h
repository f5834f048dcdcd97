// The two hierarchies that shafts link (Gibson 2003, section 6): sources halved by planes down to
// one patch, receivers in an octree of broad leaves.
// Invariant: a node's children follow it in the list; its items are a range of `order`, its
// children's ranges one after the other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/bounds.h"
#include "pipeline/patches.h"

namespace gnomon::pipeline {

struct PatchNode {
  Bounds bounds;
  std::uint32_t first = 0, count = 0;
  /// Numbers of its children, kNone where there are fewer; none at all: a leaf.
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::array<std::uint32_t, 8> children{kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  bool leaf() const { return children[0] == kNone; }
};

struct PatchTree {
  /// The root first; empty where there are no items.
  std::vector<PatchNode> nodes;
  /// Items, each once.
  std::vector<std::uint32_t> order;
  std::span<const std::uint32_t> items(const PatchNode& node) const {
    return std::span(order).subspan(node.first, node.count);
  }
};

/// Binary: the longest side of a node's bounds is cut so that each half has half of the items, down
/// to one. Items are positions in `patches`, which are numbers in the model.
PatchTree build_source_tree(const PatchModel& model, std::span<const std::uint32_t> patches);

/// An octree over centroids: a node's box is cut in eight while it has more than `leaf_patches`
/// items (and they are not all in one place). Items are numbers of patches in the model.
/// Misuse: leaf_patches is 0.
PatchTree build_receiver_tree(const PatchModel& model, std::span<const std::uint32_t> patches,
                              std::size_t leaf_patches);

}  // namespace gnomon::pipeline
