#include "pipeline/silhouette.h"

#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using test::model_of;

Silhouette of(const Topology& topology, const glm::vec4& light) {
  return find_silhouette(topology, light_in_model(light, glm::mat4(1.0f)));
}

int lit_count(const Silhouette& silhouette) {
  int count = 0;
  for (const std::int8_t casting : silhouette.casting) count += casting != 0;
  return count;
}

// Oracle: the unit cube seen from above shows one face (4 edges), from an edge's side two (6
// edges), from a corner's side three (6 edges).
TEST(Silhouette, OfACubeIsKnownForLightsBeforeAFaceAnEdgeAndACorner) {
  const Topology cube = build_topology(*model_of(test::box_mesh(glm::vec3(1.0f))));
  for (const float w : {0.0f, 1.0f}) {
    const Silhouette face = of(cube, {0.0f, 5.0f, 0.0f, w});
    EXPECT_EQ(lit_count(face), 2);
    EXPECT_EQ(face.edges.size(), 4u);
    for (const SilhouetteEdge& edge : face.edges) {
      EXPECT_EQ(cube.positions[edge.from].y, 1.0f);
      EXPECT_EQ(cube.positions[edge.to].y, 1.0f);
      EXPECT_EQ(edge.multiplicity, 1);
    }
    EXPECT_EQ(of(cube, {5.0f, 5.0f, 0.0f, w}).edges.size(), 6u);
    EXPECT_EQ(lit_count(of(cube, {5.0f, 5.0f, 0.0f, w})), 4);
    EXPECT_EQ(of(cube, {5.0f, 5.0f, 5.0f, w}).edges.size(), 6u);
    EXPECT_EQ(lit_count(of(cube, {5.0f, 5.0f, 5.0f, w})), 6);
  }
}

// Oracle: seen from the light, the top face's outline runs counter-clockwise.
TEST(Silhouette, RunsCounterClockwiseSeenFromTheLight) {
  const Topology cube = build_topology(*model_of(test::box_mesh(glm::vec3(1.0f))));
  for (const SilhouetteEdge& edge : of(cube, {0.0f, 5.0f, 0.0f, 1.0f}).edges) {
    const glm::vec3 from(cube.positions[edge.from]), to(cube.positions[edge.to]);
    EXPECT_GT(glm::cross(from, to).y, 0.0f);
  }
}

// Oracle: the definition: twelve triangles turn their backs, all cast reversed, nothing is outline.
TEST(Silhouette, LightInsideAClosedMeshIsKeptInByAllOfIt) {
  const Topology cube = build_topology(*model_of(test::box_mesh(glm::vec3(1.0f))));
  const Silhouette silhouette = of(cube, {0.0f, 0.1f, 0.2f, 1.0f});
  EXPECT_EQ(silhouette.casting, std::vector<std::int8_t>(12, -1));
  EXPECT_TRUE(silhouette.edges.empty());
}

// Oracle: the definition, with counts by hand.
TEST(Silhouette, OpenSheetCastsFromBothSides) {
  const Topology sheet = build_topology(*model_of(test::square_mesh(1.0f)));
  const Silhouette above = of(sheet, {0.0f, 1.0f, 0.0f, 0.0f});
  const Silhouette below = of(sheet, {0.0f, -1.0f, 0.0f, 0.0f});
  EXPECT_EQ(above.edges.size(), 4u);
  ASSERT_EQ(below.edges.size(), 4u);
  for (const SilhouetteEdge& edge : below.edges) {
    const glm::vec3 from(sheet.positions[edge.from]), to(sheet.positions[edge.to]);
    EXPECT_LT(glm::cross(from, to).y, 0.0f);
  }
}

TEST(Silhouette, EdgeOfThreeLitTrianglesCountsTwiceOrMore) {
  Mesh fan;
  fan.positions = {{0, 0, -1, 1}, {0, 0, 1, 1}, {1, 0, 0, 1}, {1, -0.5f, 0, 1}, {1, -1, 0, 1}};
  fan.indices = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  const Topology topology = build_topology(*model_of(fan));
  int largest = 0;
  for (const SilhouetteEdge& edge : of(topology, {0.0f, 9.0f, 0.0f, 1.0f}).edges) {
    largest = std::max(largest, edge.multiplicity);
  }
  EXPECT_EQ(largest, 3);
}

// Oracle: facing does not change when mesh and light move together.
TEST(Silhouette, LightInAMirroredModelFacesTheSameTriangles) {
  const Topology torus = build_topology(*model_of(test::torus_mesh(0.5f, 0.2f, 24, 12)));
  const glm::mat4 world = test::placed({1, 2, 3}, {1, 1, 0}, 0.7f, {-1.5f, 0.5f, 1.0f});
  for (const float w : {0.0f, 1.0f}) {
    const glm::vec4 light_model(0.3f, 2.0f, 0.4f, w);
    const glm::vec4 light_world = world * light_model;
    const Silhouette direct = of(torus, light_model);
    const Silhouette through =
        find_silhouette(torus, light_in_model({glm::vec3(light_world), w}, world));
    EXPECT_EQ(direct.casting, through.casting);
    EXPECT_EQ(direct.edges, through.edges);
  }
}

TEST(Silhouette, TransformWithoutInverseIsMisuse) {
  EXPECT_THROW(light_in_model({0, 1, 0, 1}, test::placed({}, {0, 1, 0}, 0, {1, 0, 1})),
               std::invalid_argument);
  EXPECT_THROW(light_in_model({0, 0, 0, 0}, glm::mat4(1.0f)), std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::pipeline
