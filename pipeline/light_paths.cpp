#include "pipeline/light_paths.h"

#include <algorithm>
#include <queue>
#include <utility>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// Vertices of a receiver node's patches, each once.
class NodeVertices {
 public:
  NodeVertices(const PatchModel& model, const PatchTree& receivers) {
    std::vector<std::uint32_t> seen(model.vertices.size(), 0);
    starts_.push_back(0);
    for (std::uint32_t n = 0; n < receivers.nodes.size(); ++n) {
      for (const std::uint32_t patch : receivers.items(receivers.nodes[n])) {
        for (const std::uint32_t vertex : model.patches[patch].vertices) {
          if (seen[vertex] == n + 1) continue;
          seen[vertex] = n + 1;
          vertices_.push_back(vertex);
        }
      }
      starts_.push_back(vertices_.size());
    }
  }
  std::span<const std::uint32_t> of(std::uint32_t node) const {
    return std::span(vertices_).subspan(starts_[node], starts_[node + 1] - starts_[node]);
  }

 private:
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> vertices_;
};

/// Sums of children after the children, which follow their parent in the list.
void sum_nodes(LightPaths& paths, std::span<const std::uint32_t> receiver_vertices) {
  const std::size_t columns = paths.transfers.vertices;
  const std::vector<PatchNode>& nodes = paths.sources.nodes;
  paths.node_transfer.assign(nodes.size() * columns, glm::vec3(0.0f));
  paths.node_mean.assign(nodes.size(), 0.0);
  for (std::size_t n = nodes.size(); n-- > 0;) {
    glm::vec3* const row = &paths.node_transfer[n * columns];
    if (nodes[n].leaf()) {
      const auto from = paths.transfers.row(paths.sources.order[nodes[n].first]);
      std::copy(from.begin(), from.end(), row);
    } else {
      const auto a = paths.node_row(nodes[n].children[0]), b = paths.node_row(nodes[n].children[1]);
      for (std::size_t v = 0; v < columns; ++v) row[v] = a[v] + b[v];
    }
    double sum = 0.0;
    for (const std::uint32_t v : receiver_vertices) sum += luminance(row[v]);
    if (!receiver_vertices.empty())
      paths.node_mean[n] = sum / static_cast<double>(receiver_vertices.size());
  }
}

class ShaftBuilder {
 public:
  ShaftBuilder(LightPaths& paths, const NodeVertices& vertices, const LightPathOptions& options)
      : paths_(paths), vertices_(vertices), options_(options) {
    light_.resize(paths.transfers.vertices);
    const auto root = paths.node_row(0);
    for (std::size_t v = 0; v < light_.size(); ++v)
      light_[v] =
          options.prune_share * std::max(luminance(root[v]), luminance(paths.vertex_radiance[v]));
  }

  void build() {
    paths_.shafts.push_back(link(0, 0));
    cut(0);
  }

 private:
  ShaftNode link(std::uint32_t source, std::uint32_t receiver) const {
    return {
        make_shaft(paths_.sources.nodes[source].bounds, paths_.receivers.nodes[receiver].bounds),
        source, receiver, 0, 0};
  }

  bool matters(std::uint32_t source, std::uint32_t receiver) const {
    const auto row = paths_.node_row(source);
    const auto vertices = vertices_.of(receiver);
    return std::any_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
      return luminance(row[v]) >= light_[v] && row[v] != glm::vec3(0.0f);
    });
  }
  bool gives_light(std::uint32_t source, std::uint32_t receiver) const {
    const auto row = paths_.node_row(source);
    const auto vertices = vertices_.of(receiver);
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](std::uint32_t v) { return row[v] != glm::vec3(0.0f); });
  }

  void cut(std::uint32_t number) {
    const auto [source, receiver] =
        std::pair(paths_.shafts[number].source, paths_.shafts[number].receiver);
    const PatchNode &s = paths_.sources.nodes[source], &r = paths_.receivers.nodes[receiver];
    const bool ends = s.leaf() && r.leaf();
    if (ends || !matters(source, receiver)) {
      ++paths_.leaf_shafts;
      if (!ends) ++paths_.pruned_shafts;
      return;
    }
    std::vector<ShaftNode> children;
    for_each_child(paths_.sources, source, [&](std::uint32_t a) {
      for_each_child(paths_.receivers, receiver, [&](std::uint32_t b) {
        if (options_.drop_pruned && !matters(a, b)) {
          ++paths_.pruned_shafts;
          return;
        }
        if (gives_light(a, b)) children.push_back(link(a, b));
      });
    });
    const auto first = static_cast<std::uint32_t>(paths_.shafts.size());
    paths_.shafts[number].first_child = first;
    paths_.shafts[number].child_count = static_cast<std::uint32_t>(children.size());
    paths_.shafts.insert(paths_.shafts.end(), children.begin(), children.end());
    for (std::uint32_t i = 0; i < children.size(); ++i) cut(first + i);
  }

  /// A leaf is its own only child.
  template <class Visit>
  static void for_each_child(const PatchTree& tree, std::uint32_t node, const Visit& visit) {
    if (tree.nodes[node].leaf()) {
      visit(node);
      return;
    }
    for (const std::uint32_t child : tree.nodes[node].children) {
      if (child != PatchNode::kNone) visit(child);
    }
  }

  LightPaths& paths_;
  const NodeVertices& vertices_;
  const LightPathOptions& options_;
  std::vector<double> light_;
};

}  // namespace

LightPaths find_light_paths(const LitScene& scene, std::span<const std::uint32_t> receivers,
                            const LightPathOptions& options) {
  raster::require(options.prune_share >= 0.0 && options.prune_share <= 1.0,
                  "a share of a vertex's light is in [0, 1]");
  LightPaths paths;
  paths.transfers = compute_transfers(scene, options.transfer);
  paths.vertex_radiance = at_vertices(scene.model, scene.radiance);
  paths.sources = build_source_tree(scene.model, paths.transfers.sources);
  paths.receivers = build_receiver_tree(scene.model, receivers, options.receiver_leaf_patches);
  if (paths.sources.nodes.empty() || paths.receivers.nodes.empty()) return paths;
  const NodeVertices vertices(scene.model, paths.receivers);
  sum_nodes(paths, vertices.of(0));
  ShaftBuilder(paths, vertices, options).build();
  return paths;
}

void OccludedLight::find(const LightPaths& paths, std::span<const Bounds> objects) {
  ++frame_;
  source_tags_.resize(paths.transfers.sources.size(), 0);
  node_tags_.resize(paths.sources.nodes.size(), 0);
  receiver_node_tags_.resize(paths.receivers.nodes.size(), 0);
  sources_.clear();
  receivers_.clear();
  if (paths.shafts.empty()) return;
  visit(paths, 0, objects);
  if (!sources_.empty()) mark(paths, 0);
}

void OccludedLight::visit(const LightPaths& paths, std::uint32_t shaft,
                          std::span<const Bounds> objects) {
  const ShaftNode& node = paths.shafts[shaft];
  if (std::none_of(objects.begin(), objects.end(),
                   [&](const Bounds& box) { return !box.empty() && node.shaft.meets(box); }))
    return;
  if (node.child_count == 0) take_leaf(paths, node);
  for (std::uint32_t i = 0; i < node.child_count; ++i) visit(paths, node.first_child + i, objects);
}

void OccludedLight::take_leaf(const LightPaths& paths, const ShaftNode& leaf) {
  for (const std::uint32_t source : paths.sources.items(paths.sources.nodes[leaf.source])) {
    if (source_tags_[source] == frame_) continue;
    source_tags_[source] = frame_;
    sources_.push_back(source);
  }
  if (receiver_node_tags_[leaf.receiver] == frame_) return;
  receiver_node_tags_[leaf.receiver] = frame_;
  for (const std::uint32_t patch : paths.receivers.items(paths.receivers.nodes[leaf.receiver])) {
    if (receiver_tags_.size() <= patch) receiver_tags_.resize(patch + 1, 0);
    if (receiver_tags_[patch] == frame_) continue;
    receiver_tags_[patch] = frame_;
    receivers_.push_back(patch);
  }
}

/// Brings the tags of the sources up to the root.
bool OccludedLight::mark(const LightPaths& paths, std::uint32_t node) {
  const PatchNode& at = paths.sources.nodes[node];
  bool any = at.leaf() && source_tags_[paths.sources.order[at.first]] == frame_;
  for (const std::uint32_t child : at.children) {
    if (child != PatchNode::kNone && mark(paths, child)) any = true;
  }
  if (any) node_tags_[node] = frame_;
  return any;
}

namespace {

std::uint32_t brightest_of(const LightPaths& paths, const OccludedLight& occluded,
                           std::uint32_t node) {
  const PatchNode& at = paths.sources.nodes[node];
  if (at.leaf()) return node;
  std::uint32_t best = PatchNode::kNone;
  for (const std::uint32_t child : at.children) {
    if (child == PatchNode::kNone || !occluded.affects(child)) continue;
    const std::uint32_t leaf = brightest_of(paths, occluded, child);
    if (best == PatchNode::kNone || paths.node_mean[leaf] > paths.node_mean[best]) best = leaf;
  }
  return best;
}

}  // namespace

std::vector<SourceCluster> choose_sources(const LightPaths& paths, const OccludedLight& occluded,
                                          std::size_t count) {
  if (count == 0 || occluded.sources().empty()) return {};
  // By mean transfer; nodes of equal ones by number, so that nothing is left to chance.
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(paths.node_mean[a], b) < std::pair(paths.node_mean[b], a);
  };
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, decltype(less)> open(less);
  std::vector<std::uint32_t> done;
  open.push(0);
  while (!open.empty()) {
    const std::uint32_t node = open.top();
    const PatchNode& at = paths.sources.nodes[node];
    if (at.leaf()) {
      open.pop();
      done.push_back(node);
      continue;
    }
    std::vector<std::uint32_t> children;
    for (const std::uint32_t child : at.children) {
      if (child != PatchNode::kNone && occluded.affects(child)) children.push_back(child);
    }
    if (open.size() + done.size() - 1 + children.size() > count) break;
    open.pop();
    for (const std::uint32_t child : children) open.push(child);
  }
  for (; !open.empty(); open.pop()) done.push_back(open.top());
  std::sort(done.begin(), done.end(), [&](std::uint32_t a, std::uint32_t b) { return less(b, a); });
  std::vector<SourceCluster> clusters;
  for (const std::uint32_t node : done) {
    const std::uint32_t leaf = brightest_of(paths, occluded, node);
    clusters.push_back({node, paths.sources.order[paths.sources.nodes[leaf].first]});
  }
  return clusters;
}

}  // namespace gnomon::pipeline
