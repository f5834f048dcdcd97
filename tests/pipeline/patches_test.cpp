#include "pipeline/patches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/pipeline/lit_room.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

TEST(Patches, CoverTheSurfacesTheyComeFrom) {
  const PatchModel model = make_patches(test::room_surfaces(), 500);
  std::map<std::string, double> area;
  for (const Patch& patch : model.patches) area[model.surfaces[patch.surface]] += patch.area_m2;
  EXPECT_NEAR(area["floor"], 16.0, 1e-5);
  EXPECT_NEAR(area["back"], 12.0, 1e-5);
  EXPECT_NEAR(area["panel"], 0.64, 1e-6);
  EXPECT_NEAR(area["table"], 2 * 0.64 + 4 * 0.8 * 0.04, 1e-5);
}

TEST(Patches, AreAsManyAsAskedForOrAFewLess) {
  const Scene room = test::room_surfaces();
  for (const std::size_t count : {100, 300, 1000, 2000}) {
    const PatchModel model = make_patches(room, count);
    EXPECT_LE(model.patches.size(), count);
    EXPECT_GE(model.patches.size(), count / 3) << count;
    for (const Patch& patch : model.patches) {
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_LE(glm::length(model.corner(patch, k) - model.corner(patch, (k + 1) % 3)),
                  model.longest_edge_m * (1 + 1e-9));
    }
  }
}

TEST(Patches, OfASceneWithMoreTrianglesThanAskedForAreItsTriangles) {
  Scene scene;
  scene.objects.push_back({.name = "ball", .model = test::model_of(test::icosphere_mesh(1, 2))});
  EXPECT_EQ(make_patches(scene, 10).patches.size(), 320u);
}

// Oracle: in a surface without T-junctions each directed edge inside it is run once, and once back.
TEST(Patches, OfOneSurfaceMeetEdgeToEdge) {
  const PatchModel model = make_patches(test::room_surfaces(), 700);
  for (std::uint32_t surface = 0; surface < 6; ++surface) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Patch& patch : model.patches) {
      if (patch.surface != surface) continue;
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_TRUE(edges.insert({patch.vertices[k], patch.vertices[(k + 1) % 3]}).second);
    }
    for (const auto& [a, b] : edges) {
      if (edges.contains({b, a})) continue;
      // On the rectangle's rim: two of its sides' coordinates are extreme.
      const glm::vec3 middle = (model.vertices[a].position + model.vertices[b].position) * 0.5f;
      int extreme = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float at = axis == 1 ? middle.y - 1.5f : middle[axis];
        extreme += std::abs(std::abs(at) - (axis == 1 ? 1.5f : 2.0f)) < 1e-6f ? 1 : 0;
      }
      EXPECT_GE(extreme, 2);
    }
  }
}

TEST(Patches, FaceWhereTheirTrianglesFaced) {
  const PatchModel model = make_patches(test::room_surfaces({.table = false}), 300);
  for (const Patch& patch : model.patches) {
    EXPECT_NEAR(glm::length(patch.normal), 1.0, 1e-12);
    EXPECT_GT(glm::dot(patch.normal, glm::dvec3(0.0, 1.5, 0.0) - patch.center), 0.0);
    for (const std::uint32_t v : patch.vertices)
      EXPECT_NEAR(glm::dot(glm::dvec3(model.vertices[v].normal), patch.normal), 1.0, 1e-6);
  }
}

TEST(Patches, OfNothingAreRefused) {
  EXPECT_THROW(make_patches({}, 100), std::invalid_argument);
  EXPECT_THROW(make_patches(test::room_surfaces(), 0), std::invalid_argument);
  Mesh line = test::square_mesh(1.0f);
  for (glm::vec4& p : line.positions) p.z = 0.0f;
  Scene flat;
  flat.objects.push_back({.name = "line", .model = test::model_of(line)});
  EXPECT_THROW(make_patches(flat, 100), std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::pipeline
