// What is known once of how light goes through a real scene, so that a frame can ask which of it a
// virtual object takes away: sources and their transfers, the two trees, and the shafts between
// them (Gibson 2003, sections 4 to 6).
// Invariant: everything here follows from the lit scene and the options alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/lit_scene.h"
#include "pipeline/patch_trees.h"
#include "pipeline/shaft.h"
#include "pipeline/source_set.h"

namespace gnomon::pipeline {

struct LightPathOptions {
  TransferOptions transfer;
  std::size_t receiver_leaf_patches = 8;
  /// A shaft whose sources give each of its receivers' vertices less than this part of its light is
  /// not cut further.
  double prune_share = 0.02;
  /// Such shafts are left out, with their light, as in the paper; otherwise they stay, as leaves of
  /// several sources.
  bool drop_pruned = false;
};

struct ShaftNode {
  Shaft shaft;
  /// Nodes of the source and the receiver tree that it links.
  std::uint32_t source = 0, receiver = 0;
  /// Its children lie one after the other; none: a leaf.
  std::uint32_t first_child = 0, child_count = 0;
};

struct LightPaths {
  Transfers transfers;
  /// The radiance of each vertex, which shadows are taken from: its patches', weighted by area.
  std::vector<glm::vec3> vertex_radiance;
  /// Items are rows of `transfers`.
  PatchTree sources;
  /// Items are patches.
  PatchTree receivers;
  /// One a node of the source tree: what all its sources give each vertex together, one column a
  /// vertex, and the mean luminance of that over the receivers' vertices.
  std::vector<glm::vec3> node_transfer;
  std::vector<double> node_mean;
  /// The root first; empty without sources or receivers.
  std::vector<ShaftNode> shafts;
  std::size_t leaf_shafts = 0, pruned_shafts = 0;

  std::span<const glm::vec3> node_row(std::size_t node) const {
    return std::span(node_transfer).subspan(node * transfers.vertices, transfers.vertices);
  }
};

/// `receivers`: patches that shadows may be seen on. Errors: as compute_transfers.
LightPaths find_light_paths(const LitScene& scene, std::span<const std::uint32_t> receivers,
                            const LightPathOptions& options);

/// What a traversal found, kept between frames: nothing is cleared, a frame number tells old tags
/// from new (section 6.1).
class OccludedLight {
 public:
  /// Visits the shafts that a box meets.
  void find(const LightPaths& paths, std::span<const Bounds> objects);

  /// Rows of the transfers whose light a box may hide, and patches it may be hidden from; each
  /// once, in the order of the traversal.
  std::span<const std::uint32_t> sources() const { return sources_; }
  std::span<const std::uint32_t> receivers() const { return receivers_; }
  /// Is one of the node's sources among them?
  bool affects(std::uint32_t source_node) const { return node_tags_[source_node] == frame_; }

 private:
  void visit(const LightPaths& paths, std::uint32_t shaft, std::span<const Bounds> objects);
  void take_leaf(const LightPaths& paths, const ShaftNode& leaf);
  bool mark(const LightPaths& paths, std::uint32_t node);

  std::uint64_t frame_ = 0;
  std::vector<std::uint64_t> source_tags_, receiver_tags_, node_tags_, receiver_node_tags_;
  std::vector<std::uint32_t> sources_, receivers_;
};

/// A source, or several in one, that a shadow is made for.
struct SourceCluster {
  /// A node of the source tree.
  std::uint32_t node = 0;
  /// The row whose patch gives most: its centre is where the shadow is cast from.
  std::uint32_t brightest = 0;
};

/// At most `count` nodes of the source tree that hold all occluded sources: the one that gives most
/// is parted again and again (section 8). Sorted by falling mean transfer, as section 7.1.1 asks.
std::vector<SourceCluster> choose_sources(const LightPaths& paths, const OccludedLight& occluded,
                                          std::size_t count);

}  // namespace gnomon::pipeline
