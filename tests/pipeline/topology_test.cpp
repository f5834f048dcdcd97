#include "pipeline/topology.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using test::model_of;

// Oracle: Euler's formula, V - E + F = 2 for the cube, 0 for the torus.
TEST(Topology, CubeAndTorusAreClosedWithTheirEulerCharacteristic) {
  const Topology cube = build_topology(*model_of(test::box_mesh(glm::vec3(1.0f))));
  EXPECT_EQ(cube.positions.size(), 8u);
  EXPECT_EQ(cube.edges.size(), 18u);
  EXPECT_EQ(cube.faults, TopologyFaults{});
  const Topology torus = build_topology(*model_of(test::torus_mesh(0.5f, 0.2f, 12, 7)));
  EXPECT_EQ(torus.positions.size() + torus.triangle_count(), torus.edges.size());
  EXPECT_TRUE(torus.closed() && torus.faults.closed_manifold());
  const Topology sphere = build_topology(*model_of(test::icosphere_mesh(1.0f, 2)));
  EXPECT_EQ(sphere.positions.size() + sphere.triangle_count(), sphere.edges.size() + 2);
}

// Oracle: a flat-shaded cube is the cube.
TEST(Topology, FlatShadedCubeIsWeldedToEightVertices) {
  const Topology cube = build_topology(*model_of(test::flat_box_mesh(glm::vec3(1.0f))));
  EXPECT_EQ(cube.positions.size(), 8u);
  EXPECT_EQ(cube.edges.size(), 18u);
  EXPECT_TRUE(cube.faults.closed_manifold());
}

TEST(Topology, MinusZeroIsZeroAndTheFirstVertexKeepsItsBits) {
  Mesh mesh;
  mesh.positions = {{-0.0f, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1},
                    {0.0f, 0, 0, 1},  {0, 1, 0, 1}, {-1, 0, 0, 1}};
  mesh.indices = {0, 1, 2, 3, 4, 5};
  const Topology topology = build_topology(*model_of(mesh));
  ASSERT_EQ(topology.positions.size(), 4u);
  EXPECT_TRUE(std::signbit(topology.positions[0].x));
  EXPECT_EQ(topology.edges.size(), 5u);
}

TEST(Topology, PartsOfAModelAreOneCaster) {
  const Mesh box = test::box_mesh(glm::vec3(1.0f));
  Model model;
  model.parts.resize(2);
  model.parts[0].mesh.positions = model.parts[1].mesh.positions = box.positions;
  model.parts[0].mesh.indices.assign(box.indices.begin(), box.indices.begin() + 12);
  model.parts[1].mesh.indices.assign(box.indices.begin() + 12, box.indices.end());
  EXPECT_TRUE(build_topology(model).faults.closed_manifold());
}

// Oracle: counted by hand.
TEST(Topology, FaultsAreCountedAndSaid) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  mesh.indices.resize(33);
  EXPECT_EQ(build_topology(*model_of(mesh)).faults.boundary_edges, 3u);

  mesh = test::box_mesh(glm::vec3(1.0f));
  std::swap(mesh.indices[1], mesh.indices[2]);
  const Topology turned = build_topology(*model_of(mesh));
  EXPECT_EQ(turned.faults.inconsistent_edges, 3u);
  EXPECT_FALSE(turned.closed());

  mesh = test::box_mesh(glm::vec3(1.0f));
  mesh.indices.insert(mesh.indices.end(), {0, 4, 6, 0, 0, 1});
  const Topology doubled = build_topology(*model_of(mesh));
  EXPECT_EQ(doubled.faults.non_manifold_edges, 3u);
  EXPECT_EQ(doubled.faults.dropped_triangles, 1u);
  EXPECT_FALSE(describe(doubled.faults).empty());
  EXPECT_TRUE(describe(TopologyFaults{}).empty());
}

TEST(Topology, TriangleWithACoordinateThatIsNoNumberIsDropped) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  mesh.positions[7].y = std::numeric_limits<float>::quiet_NaN();
  const Topology topology = build_topology(*model_of(mesh));
  EXPECT_GT(topology.faults.dropped_triangles, 0u);
  EXPECT_EQ(topology.triangle_count() + topology.faults.dropped_triangles, 12u);
}

TEST(Topology, IndexOutOfRangeIsMisuse) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  mesh.indices[5] = 8;
  EXPECT_THROW(build_topology(*model_of(mesh)), std::invalid_argument);
}

TEST(Topology, CacheBuildsAModelOnce) {
  TopologyCache cache;
  const auto model = model_of(test::box_mesh(glm::vec3(1.0f)));
  EXPECT_EQ(cache.of(model), cache.of(model));
}

// Oracle: a box of edges a, b, c has 2 V / A = a b c / (a b + b c + c a).
TEST(Topology, ThicknessIsTwiceTheVolumeByTheArea) {
  Mesh box = test::box_mesh({1.0f, 0.5f, 0.25f});
  EXPECT_NEAR(build_topology(*test::model_of(box)).thickness, 1.0 / (2.0 + 0.5 + 1.0), 1e-12);
  // Inside out, and far from the origin.
  for (std::size_t i = 0; i < box.indices.size(); i += 3)
    std::swap(box.indices[i], box.indices[i + 1]);
  for (glm::vec4& p : box.positions) p += glm::vec4(64.0f, -32.0f, 8.0f, 0.0f);
  EXPECT_NEAR(build_topology(*test::model_of(box)).thickness, -1.0 / 3.5, 1e-12);
  EXPECT_EQ(build_topology(*test::model_of(test::square_mesh(1.0f))).thickness, 0.0);
}

}  // namespace
}  // namespace gnomon::pipeline
