#include "pipeline/silhouette.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

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

// A lamp in a face, an edge or a corner is turned to by no face, so without the others nothing
// would cast. Oracle: the definition, with counts by hand.
TEST(Silhouette, LightOnAClosedMeshCastsWithAllFacesThatItIsNotIn) {
  const Topology cube = build_topology(*model_of(test::box_mesh(glm::vec3(1.0f))));
  const auto reversed = [&](const glm::vec3& at) {
    const auto casting = of(cube, glm::vec4(at, 1.0f)).casting;
    return std::count(casting.begin(), casting.end(), std::int8_t{-1});
  };
  EXPECT_EQ(reversed({0.25f, 1.0f, -0.125f}), 10);
  EXPECT_EQ(reversed({0.0f, 1.0f, 0.0f}), 10);
  EXPECT_EQ(reversed({1.0f, 1.0f, 0.5f}), 8);
  EXPECT_EQ(reversed({-1.0f, 1.0f, -1.0f}), 6);
  // In the plane of a face and beside it: as ever.
  EXPECT_EQ(reversed({0.0f, 1.0f, 1.5f}), 0);
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

/// The definition, one triangle and one edge at a time.
Silhouette by_definition(const Topology& topology, const glm::dvec4& light, bool both_sides) {
  Silhouette result;
  for (std::size_t t = 0; t < topology.triangle_count(); ++t) {
    const auto corner = [&](std::size_t k) {
      return glm::dvec3(topology.positions[topology.indices[3 * t + k]]);
    };
    const glm::dvec3 a = corner(0);
    const double facing =
        glm::dot(glm::cross(corner(1) - a, corner(2) - a), glm::dvec3(light) - a * light.w);
    result.casting.push_back(facing > 0.0 ? 1 : facing < 0.0 && both_sides ? -1 : 0);
  }
  for (const Edge& edge : topology.edges) {
    int sum = 0;
    for (const EdgeUse& use : topology.uses_of(edge))
      sum += use.sign * result.casting[use.triangle];
    if (sum > 0) result.edges.push_back({edge.a, edge.b, sum});
    if (sum < 0) result.edges.push_back({edge.b, edge.a, -sum});
  }
  return result;
}

// Oracle: the definition, evaluated from the corners; lights in the plane of a triangle too, where
// one rounding more would decide otherwise.
TEST(Silhouette, IsTheDefinitionToTheBitForClosedOpenAndNonManifoldMeshes) {
  std::mt19937 random(71);
  std::vector<Mesh> meshes = {test::box_mesh(glm::vec3(0.5f)), test::torus_mesh(0.6f, 0.2f, 12, 8),
                              test::icosphere_mesh(0.7f, 2), test::square_mesh(0.8f)};
  for (int i = 0; i < 100; ++i) meshes.push_back(test::soup(random));
  std::size_t outlines = 0, edge_on = 0;
  Silhouette silhouette;
  for (const Mesh& mesh : meshes) {
    const Topology topology = build_topology(*model_of(mesh));
    for (int i = 0; i < 20; ++i) {
      glm::vec3 at = test::uniform_point(random, 2.0f, 4.0f);
      if (i % 2) at.x = -at.x;
      const bool in_plane = i % 4 == 0 && topology.triangle_count() > 0;
      if (in_plane) {
        const std::uint32_t* corner = &topology.indices[3 * (random() % topology.triangle_count())];
        const glm::vec3 a(topology.positions[corner[0]]), b(topology.positions[corner[1]]);
        at = a + (b - a) * 16.0f;
      }
      const glm::dvec4 light(glm::dvec3(at), i % 3 == 0 && !in_plane ? 0.0 : 1.0);
      find_silhouette(topology, light, silhouette);
      const Silhouette expected = by_definition(topology, light, !topology.closed());
      ASSERT_EQ(silhouette.casting, expected.casting);
      ASSERT_EQ(silhouette.edges, expected.edges);
      outlines += !silhouette.edges.empty();
      for (const std::int8_t casting : silhouette.casting) {
        edge_on += casting == 0 && !topology.closed();
      }
    }
  }
  EXPECT_GT(outlines, 1000u);
  EXPECT_GT(edge_on, 0u);
}

TEST(Silhouette, TransformWithoutInverseIsMisuse) {
  EXPECT_THROW(light_in_model({0, 1, 0, 1}, test::placed({}, {0, 1, 0}, 0, {1, 0, 1})),
               std::invalid_argument);
  EXPECT_THROW(light_in_model({0, 0, 0, 0}, glm::mat4(1.0f)), std::invalid_argument);
}

std::vector<SilhouetteEdge> sorted_edges(Silhouette silhouette) {
  std::sort(silhouette.edges.begin(), silhouette.edges.end(),
            [](const SilhouetteEdge& a, const SilhouetteEdge& b) {
              return std::pair(a.from, a.to) < std::pair(b.from, b.to);
            });
  return silhouette.edges;
}

Silhouette classical_of(const Topology& topology, const glm::vec4& light) {
  Silhouette silhouette;
  find_classical_silhouette(topology, light_in_model(light, glm::mat4(1.0f)), silhouette);
  return silhouette;
}

// Oracle: for closed manifolds both are the same by definition.
TEST(ClassicalSilhouette, OfClosedManifoldsIsTheSilhouette) {
  std::mt19937 random(7);
  for (const pipeline::Mesh& mesh :
       {test::box_mesh(glm::vec3(1.0f)), test::torus_mesh(0.7f, 0.2f, 24, 12),
        test::icosphere_mesh(1.0f, 2)}) {
    const Topology topology = build_topology(*model_of(mesh));
    ASSERT_TRUE(topology.faults.closed_manifold());
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 at = glm::normalize(test::uniform_point(random, -1.0f, 1.0f)) * 3.0f;
      const glm::vec4 light(at, i % 2 == 0 ? 1.0f : 0.0f);
      EXPECT_EQ(sorted_edges(classical_of(topology, light)), sorted_edges(of(topology, light)));
    }
  }
}

// Oracle: an open square casts from both sides by the silhouette, from its face alone classically.
TEST(ClassicalSilhouette, ForgetsTheBackOfASheet) {
  const Topology square = build_topology(*model_of(test::square_mesh(1.0f)));
  EXPECT_EQ(classical_of(square, {0.0f, 2.0f, 0.0f, 1.0f}).edges.size(), 4u);
  EXPECT_EQ(classical_of(square, {0.0f, -2.0f, 0.0f, 1.0f}).edges.size(), 0u);
  EXPECT_EQ(of(square, {0.0f, -2.0f, 0.0f, 1.0f}).edges.size(), 4u);
}

// Oracle: three triangles at one edge, all facing the light: the edge is run twice one way and once
// the other, so the robust outline has it once; the classical one sees two that face and drops it.
TEST(ClassicalSilhouette, ForgetsTheThirdTriangleOfAnEdge) {
  pipeline::Mesh fan;
  fan.positions = {
      {0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0.5f, 1}, {-1, 0, 0.5f, 1}, {-1, 0.5f, 0.5f, 1}};
  fan.indices = {0, 1, 2, 1, 0, 3, 1, 0, 4};
  const Topology topology = build_topology(*model_of(fan));
  ASSERT_EQ(topology.faults.non_manifold_edges, 1u);
  const auto has_shared_edge = [](const Silhouette& silhouette) {
    return std::any_of(silhouette.edges.begin(), silhouette.edges.end(),
                       [](const SilhouetteEdge& edge) { return edge.from + edge.to == 1; });
  };
  const glm::vec4 above{0.0f, 5.0f, 0.5f, 1.0f};
  EXPECT_TRUE(has_shared_edge(of(topology, above)));
  EXPECT_FALSE(has_shared_edge(classical_of(topology, above)));
}

}  // namespace
}  // namespace gnomon::pipeline
