#include "pipeline/light_paths.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/patch_light.h"
#include "tests/pipeline/lit_room.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

std::vector<std::uint32_t> all_patches(const LitScene& scene) {
  std::vector<std::uint32_t> all(scene.model.patches.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

Bounds box_at(const glm::dvec3& center, double half) {
  Bounds box;
  box.add(center - half);
  box.add(center + half);
  return box;
}

TEST(SourceSet, IsTheBrightestPatchesUpToAShareOfThePower) {
  const LitScene scene = test::lit_room();
  double power = 0.0;
  for (std::size_t i = 0; i < scene.radiance.size(); ++i)
    power += luminance(scene.radiance[i]) * scene.model.patches[i].area_m2;
  for (const double share : {0.0, 0.3, 0.7, 1.0}) {
    const std::vector<std::uint32_t> sources = find_sources(scene, share);
    ASSERT_FALSE(sources.empty());
    double sum = 0.0, but_last = 0.0;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      EXPECT_GE(luminance(scene.radiance[sources[i == 0 ? 0 : i - 1]]),
                luminance(scene.radiance[sources[i]]));
      but_last = sum;
      sum += luminance(scene.radiance[sources[i]]) * scene.model.patches[sources[i]].area_m2;
    }
    EXPECT_GE(sum, share * power * (1 - 1e-9));
    if (sources.size() > 1) {
      EXPECT_LT(but_last, share * power);
    }
  }
  EXPECT_THROW(find_sources(scene, 1.1), std::invalid_argument);
}

TEST(SourceSet, OfADarkRoomIsEmpty) {
  LitScene scene = test::lit_room({.bounces = 0});
  std::fill(scene.radiance.begin(), scene.radiance.end(), glm::vec3(0.0f));
  const auto all = all_patches(scene);
  const LightPaths paths = find_light_paths(scene, all, {});
  EXPECT_TRUE(paths.transfers.sources.empty());
  EXPECT_TRUE(paths.shafts.empty());
  OccludedLight occluded;
  const Bounds box = box_at({0, 1, 0}, 0.2);
  occluded.find(paths, std::span(&box, 1));
  EXPECT_TRUE(occluded.sources().empty());
  EXPECT_TRUE(choose_sources(paths, occluded, 10).empty());
}

// Oracle: the irradiance of the vertex, times its reflectance over pi.
TEST(Transfers, OfAllSourcesAddUpToWhatTheVertexReflects) {
  const LitScene scene = test::lit_room();
  const Transfers transfers = compute_transfers(scene, {.power_share = 1.0, .samples = 4});
  const std::vector<glm::vec3> reflectance = at_vertices(scene.model, scene.reflectance);
  const PatchVisibility visibility(scene.model);
  for (std::size_t v = 0; v < transfers.vertices; v += 7) {
    glm::dvec3 sum(0.0);
    for (std::size_t s = 0; s < transfers.sources.size(); ++s)
      sum += glm::dvec3(transfers.row(s)[v]);
    const PatchVertex& vertex = scene.model.vertices[v];
    const glm::dvec3 expected =
        glm::dvec3(reflectance[v]) *
        irradiance(scene.model, scene.radiance, visibility, glm::dvec3(vertex.position),
                   glm::dvec3(vertex.normal), 4) /
        3.14159265358979323846;
    EXPECT_NEAR(sum.x, expected.x, 1e-4 * expected.x + 1e-6);
    EXPECT_NEAR(sum.z, expected.z, 1e-4 * expected.z + 1e-6);
  }
}

TEST(Transfers, AreTheSameForEveryNumberOfThreads) {
  const LitScene scene = test::lit_room();
  const Transfers one = compute_transfers(scene, {.threads = 1});
  for (const int threads : {2, 3, 7}) {
    const Transfers many = compute_transfers(scene, {.threads = threads});
    EXPECT_EQ(one.sources, many.sources);
    EXPECT_TRUE(one.radiance == many.radiance);
  }
}

void expect_sound(const PatchTree& tree, const PatchModel& model,
                  const std::function<std::uint32_t(std::uint32_t)>& patch_of,
                  std::size_t leaf_items) {
  std::set<std::uint32_t> seen(tree.order.begin(), tree.order.end());
  EXPECT_EQ(seen.size(), tree.order.size());
  for (const PatchNode& node : tree.nodes) {
    for (const std::uint32_t item : tree.items(node)) {
      Bounds patch;
      for (std::size_t k = 0; k < 3; ++k) patch.add(model.corner(model.patches[patch_of(item)], k));
      Bounds joined = node.bounds;
      joined.add(patch);
      EXPECT_EQ(joined.low, node.bounds.low);
      EXPECT_EQ(joined.high, node.bounds.high);
    }
    if (node.leaf()) {
      EXPECT_LE(node.count, leaf_items);
      continue;
    }
    std::uint32_t at = node.first;
    for (const std::uint32_t child : node.children) {
      if (child == PatchNode::kNone) continue;
      EXPECT_EQ(tree.nodes[child].first, at);
      at += tree.nodes[child].count;
    }
    EXPECT_EQ(at, node.first + node.count);
  }
}

TEST(PatchTrees, HoldEachPatchOnceInBoundsThatHoldItDownToTheirLeaves) {
  const LitScene scene = test::lit_room({.patches = 600});
  const auto all = all_patches(scene);
  const std::vector<std::uint32_t> sources = find_sources(scene, 0.7);
  const PatchTree source_tree = build_source_tree(scene.model, sources);
  expect_sound(
      source_tree, scene.model, [&](std::uint32_t i) { return sources[i]; }, 1);
  EXPECT_EQ(source_tree.nodes.size(), 2 * sources.size() - 1);
  for (const std::size_t leaf : {std::size_t{1}, std::size_t{8}, std::size_t{50}}) {
    expect_sound(
        build_receiver_tree(scene.model, all, leaf), scene.model, [](std::uint32_t i) { return i; },
        leaf);
  }
}

/// Does the segment meet the box? By slabs.
bool meets(const glm::dvec3& a, const glm::dvec3& b, const Bounds& box) {
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = b[axis] - a[axis];
    double near = (box.low[axis] - a[axis]) / step, far = (box.high[axis] - a[axis]) / step;
    if (near > far) std::swap(near, far);
    first = std::max(first, near);
    last = std::min(last, far);
  }
  return first <= last;
}

// Oracle: random lines between the boxes.
TEST(Shaft, NeverMissesABoxThatALineMeets) {
  std::mt19937 random(3);
  int met = 0, missed = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto box = [&](float spread, float size) {
      Bounds out;
      const glm::dvec3 p(test::uniform_point(random, -spread, spread));
      out.add(p);
      // Flat ones too, as patches are.
      glm::dvec3 extent(test::uniform_point(random, 0.0f, size));
      if (i % 3 == 0) extent[i % 9 / 3] = 0.0;
      out.add(p + extent);
      return out;
    };
    const Bounds a = box(1.0f, 1.0f), b = box(1.0f, 1.0f), object = box(1.5f, 0.6f);
    const Shaft shaft = make_shaft(a, b);
    bool hit = false;
    for (int k = 0; k < 200; ++k) {
      const auto inside = [&](const Bounds& of) {
        return of.low + glm::dvec3(test::uniform_point(random, 0.0f, 1.0f)) * (of.high - of.low);
      };
      hit = hit || meets(inside(a), inside(b), object);
    }
    EXPECT_TRUE(!hit || shaft.meets(object));
    met += hit ? 1 : 0;
    missed += shaft.meets(object) ? 0 : 1;
  }
  EXPECT_GT(met, 80);
  EXPECT_GT(missed, 800);
}

TEST(Shaft, MissesABoxBesideIt) {
  const Shaft shaft = make_shaft(box_at({0, 0, 0}, 0.1), box_at({3, 3, 0}, 0.1));
  EXPECT_TRUE(shaft.meets(box_at({1.5, 1.5, 0.0}, 0.1)));
  // Inside the box around both.
  EXPECT_FALSE(shaft.meets(box_at({2.5, 0.5, 0.0}, 0.2)));
  EXPECT_FALSE(shaft.meets(box_at({1.5, 1.5, 0.5}, 0.1)));
}

// Oracle: rays between each source's corners and each receiver vertex.
TEST(OccludedLight, HoldsEverySourceThatABoxHidesFromAReceiver) {
  const LitScene scene = test::lit_room();
  const auto all = all_patches(scene);
  const LightPaths paths =
      find_light_paths(scene, all, {.transfer = {.power_share = 0.3}, .prune_share = 0.0});
  std::mt19937 random(4);
  OccludedLight occluded;
  std::size_t fewest = all.size();
  for (int trial = 0; trial < 12; ++trial) {
    const Bounds box =
        box_at({test::uniform(random, -1.5f, 1.5f), test::uniform(random, 0.3f, 2.5f),
                test::uniform(random, -1.5f, 1.5f)},
               0.15);
    occluded.find(paths, std::span(&box, 1));
    std::set<std::uint32_t> found(occluded.sources().begin(), occluded.sources().end());
    std::set<std::uint32_t> receivers(occluded.receivers().begin(), occluded.receivers().end());
    EXPECT_EQ(found.size(), occluded.sources().size());
    EXPECT_EQ(receivers.size(), occluded.receivers().size());
    for (std::uint32_t s = 0; s < paths.transfers.sources.size(); ++s) {
      const Patch& source = scene.model.patches[paths.transfers.sources[s]];
      for (const std::uint32_t r : all) {
        const Patch& receiver = scene.model.patches[r];
        for (std::size_t k = 0; k < 3; ++k) {
          const std::uint32_t v = receiver.vertices[k];
          if (paths.transfers.row(s)[v] == glm::vec3(0.0f)) continue;
          if (!meets(source.center, glm::dvec3(scene.model.vertices[v].position), box)) continue;
          EXPECT_TRUE(found.contains(s));
          EXPECT_TRUE(receivers.contains(r));
        }
      }
    }
    fewest = std::min(fewest, receivers.size());
  }
  EXPECT_LT(fewest, all.size());
}

TEST(OccludedLight, OfABoxOutsideEveryShaftIsEmpty) {
  const LitScene scene = test::lit_room();
  const auto all = all_patches(scene);
  const LightPaths paths = find_light_paths(scene, all, {});
  OccludedLight occluded;
  const Bounds box = box_at({0, 10, 0}, 0.5);
  occluded.find(paths, std::span(&box, 1));
  EXPECT_TRUE(occluded.sources().empty());
  EXPECT_TRUE(occluded.receivers().empty());
  // And what an earlier frame found is forgotten.
  const Bounds inside = box_at({0, 1, 0}, 0.2);
  occluded.find(paths, std::span(&inside, 1));
  EXPECT_FALSE(occluded.sources().empty());
  occluded.find(paths, std::span(&box, 1));
  EXPECT_TRUE(occluded.sources().empty());
}

TEST(LightPaths, PrunedShaftsStayAsLeavesUnlessTheyAreDropped) {
  const LitScene scene = test::lit_room();
  const auto all = all_patches(scene);
  const LightPaths full = find_light_paths(scene, all, {.prune_share = 0.0});
  const LightPaths kept = find_light_paths(scene, all, {.prune_share = 0.02});
  const LightPaths dropped =
      find_light_paths(scene, all, {.prune_share = 0.02, .drop_pruned = true});
  EXPECT_EQ(full.pruned_shafts, 0u);
  EXPECT_LT(kept.leaf_shafts, full.leaf_shafts);
  EXPECT_LT(dropped.leaf_shafts, kept.leaf_shafts);
  OccludedLight in_full, in_kept;
  const Bounds box = box_at({0.2, 0.8, 0.1}, 0.2);
  in_full.find(full, std::span(&box, 1));
  in_kept.find(kept, std::span(&box, 1));
  std::set<std::uint32_t> found(in_kept.sources().begin(), in_kept.sources().end());
  for (const std::uint32_t source : in_full.sources()) EXPECT_TRUE(found.contains(source));
}

TEST(ChooseSources, TakesAtMostSoManyNodesThatHoldAllOccludedSourcesOnce) {
  const LitScene scene = test::lit_room({.patches = 600});
  const auto all = all_patches(scene);
  const LightPaths paths = find_light_paths(scene, all, {});
  OccludedLight occluded;
  const Bounds box = box_at({0.2, 0.8, 0.1}, 0.2);
  occluded.find(paths, std::span(&box, 1));
  const std::size_t sources = occluded.sources().size();
  ASSERT_GT(sources, 20u);
  for (const std::size_t count : {std::size_t{1}, std::size_t{5}, std::size_t{20}, sources + 5}) {
    const std::vector<SourceCluster> chosen = choose_sources(paths, occluded, count);
    EXPECT_LE(chosen.size(), count);
    EXPECT_GE(chosen.size(), std::min(count, sources) - (count > 1 && count < sources ? 1 : 0));
    std::multiset<std::uint32_t> held;
    double before = paths.node_mean[chosen[0].node];
    for (const SourceCluster& cluster : chosen) {
      EXPECT_LE(paths.node_mean[cluster.node], before);
      before = paths.node_mean[cluster.node];
      const auto items = paths.sources.items(paths.sources.nodes[cluster.node]);
      held.insert(items.begin(), items.end());
      EXPECT_TRUE(std::find(items.begin(), items.end(), cluster.brightest) != items.end());
    }
    for (const std::uint32_t source : occluded.sources()) EXPECT_EQ(held.count(source), 1u);
  }
  EXPECT_EQ(choose_sources(paths, occluded, sources + 5).size(), sources);
  EXPECT_TRUE(choose_sources(paths, occluded, 0).empty());
}

}  // namespace
}  // namespace gnomon::pipeline
