#include "pipeline/patch_trees.h"

#include <algorithm>
#include <numeric>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

Bounds bounds_of(const PatchModel& model, const Patch& patch) {
  Bounds bounds;
  for (std::size_t k = 0; k < 3; ++k) bounds.add(model.corner(patch, k));
  return bounds;
}

/// Deep enough for any two centroids that doubles of a house tell apart.
constexpr int kDeepest = 40;

class SourceTreeBuilder {
 public:
  SourceTreeBuilder(const PatchModel& model, std::span<const std::uint32_t> patches,
                    PatchTree& tree)
      : model_(model), patches_(patches), tree_(tree) {}

  std::uint32_t build(std::uint32_t first, std::uint32_t count) {
    const auto number = static_cast<std::uint32_t>(tree_.nodes.size());
    PatchNode node{.bounds = {}, .first = first, .count = count};
    for (std::uint32_t i = first; i < first + count; ++i)
      node.bounds.add(bounds_of(model_, patch(tree_.order[i])));
    tree_.nodes.push_back(node);
    if (count < 2) return number;
    const glm::dvec3 size = node.bounds.high - node.bounds.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = tree_.order.begin() + first;
    std::stable_sort(begin, begin + count, [&](std::uint32_t a, std::uint32_t b) {
      return patch(a).center[axis] < patch(b).center[axis];
    });
    const std::uint32_t left = build(first, count / 2);
    const std::uint32_t right = build(first + count / 2, count - count / 2);
    tree_.nodes[number].children[0] = left;
    tree_.nodes[number].children[1] = right;
    return number;
  }

 private:
  const Patch& patch(std::uint32_t item) const { return model_.patches[patches_[item]]; }

  const PatchModel& model_;
  std::span<const std::uint32_t> patches_;
  PatchTree& tree_;
};

class ReceiverTreeBuilder {
 public:
  ReceiverTreeBuilder(const PatchModel& model, std::size_t leaf_patches, PatchTree& tree)
      : model_(model), leaf_patches_(leaf_patches), tree_(tree) {}

  std::uint32_t build(std::uint32_t first, std::uint32_t count, const Bounds& cell, int depth) {
    const auto number = static_cast<std::uint32_t>(tree_.nodes.size());
    PatchNode node{.bounds = {}, .first = first, .count = count};
    for (const std::uint32_t item : std::span(tree_.order).subspan(first, count))
      node.bounds.add(bounds_of(model_, model_.patches[item]));
    tree_.nodes.push_back(node);
    if (count <= leaf_patches_ || depth == kDeepest) return number;
    const auto octant = [&](std::uint32_t item) {
      const glm::dvec3 p = model_.patches[item].center, middle = cell.center();
      return (p.x > middle.x ? 1u : 0u) | (p.y > middle.y ? 2u : 0u) | (p.z > middle.z ? 4u : 0u);
    };
    const auto begin = tree_.order.begin() + first;
    std::stable_sort(begin, begin + count,
                     [&](std::uint32_t a, std::uint32_t b) { return octant(a) < octant(b); });
    std::size_t child = 0;
    for (std::uint32_t at = first; at < first + count;) {
      const std::uint32_t which = octant(tree_.order[at]);
      std::uint32_t end = at;
      while (end < first + count && octant(tree_.order[end]) == which) ++end;
      const std::uint32_t built = build(at, end - at, part(cell, which), depth + 1);
      tree_.nodes[number].children[child++] = built;
      at = end;
    }
    return number;
  }

 private:
  static Bounds part(const Bounds& cell, std::uint32_t which) {
    Bounds out = cell;
    const glm::dvec3 middle = cell.center();
    for (int axis = 0; axis < 3; ++axis)
      ((which >> axis & 1u) ? out.low : out.high)[axis] = middle[axis];
    return out;
  }

  const PatchModel& model_;
  const std::size_t leaf_patches_;
  PatchTree& tree_;
};

}  // namespace

PatchTree build_source_tree(const PatchModel& model, std::span<const std::uint32_t> patches) {
  PatchTree tree;
  tree.order.resize(patches.size());
  std::iota(tree.order.begin(), tree.order.end(), 0u);
  if (!patches.empty())
    SourceTreeBuilder(model, patches, tree).build(0, static_cast<std::uint32_t>(patches.size()));
  return tree;
}

PatchTree build_receiver_tree(const PatchModel& model, std::span<const std::uint32_t> patches,
                              std::size_t leaf_patches) {
  raster::require(leaf_patches > 0, "a leaf has room for a patch");
  PatchTree tree;
  tree.order.assign(patches.begin(), patches.end());
  if (patches.empty()) return tree;
  Bounds cell;
  for (const std::uint32_t item : patches) cell.add(model.patches[item].center);
  ReceiverTreeBuilder(model, leaf_patches, tree)
      .build(0, static_cast<std::uint32_t>(patches.size()), cell, 0);
  return tree;
}

}  // namespace gnomon::pipeline
