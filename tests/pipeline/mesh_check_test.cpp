// What check_mesh finds. Oracles: meshes whose topology is known, Euler's formula, counts by hand,
// and defects put one by one into closed meshes.
#include "pipeline/mesh_check.h"

#include <algorithm>
#include <limits>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using test::model_of;
using testing::ElementsAre;
using testing::HasSubstr;

MeshCheck check(Mesh mesh) { return check_mesh(*model_of(std::move(mesh))); }

void expect_no_faults_or_notes(const MeshCheck& c) {
  EXPECT_TRUE(c.casts_classical_volume());
  for (const MeshFinding* finding :
       {&c.open_edges, &c.non_manifold_edges, &c.misoriented_edges, &c.non_finite_vertices,
        &c.outlines, &c.degenerate_triangles, &c.duplicate_triangles, &c.unwelded_vertices,
        &c.t_junctions, &c.unreferenced_vertices, &c.touching_vertices, &c.inward_pieces,
        &c.self_intersections})
    EXPECT_EQ(finding->count, 0u);
  EXPECT_EQ(describe(c), "");
}

/// Adds a mesh's triangles to another's.
void append(Mesh& to, const Mesh& from, const glm::vec3& by = glm::vec3(0.0f)) {
  const auto base = static_cast<std::uint32_t>(to.positions.size());
  for (const glm::vec4& p : from.positions) to.positions.push_back(p + glm::vec4(by, 0.0f));
  for (const std::uint32_t i : from.indices) to.indices.push_back(base + i);
  to.normals.clear();
}

TEST(MeshCheck, ClosedTorusHasNothingToSayAndEulerCharacteristicZero) {
  const MeshCheck torus = check(test::torus_mesh(0.5f, 0.2f, 24, 12));
  expect_no_faults_or_notes(torus);
  EXPECT_EQ(torus.triangles, 576u);
  EXPECT_EQ(torus.welded_vertices, 288u);
  EXPECT_EQ(torus.euler_characteristic, 0);
  EXPECT_EQ(torus.pieces, 1u);
  const MeshCheck sphere = check(test::icosphere_mesh(1.0f, 3));
  expect_no_faults_or_notes(sphere);
  EXPECT_EQ(sphere.euler_characteristic, 2);
}

TEST(MeshCheck, OpenPlaneHasFourOpenEdgesInOneOutline) {
  const MeshCheck c = check(test::square_mesh(1.0f));
  EXPECT_FALSE(c.casts_classical_volume());
  EXPECT_EQ(c.open_edges.count, 4u);
  EXPECT_EQ(c.outlines.count, 1u);
  EXPECT_EQ(c.longest_outline, 4u);
  ASSERT_EQ(c.open_edges.first.size(), 4u);
  EXPECT_THAT(c.open_edges.first[0].vertices, ElementsAre(0, 1));
  EXPECT_THAT(c.open_edges.first[0].triangles, ElementsAre(0));
  EXPECT_EQ(c.open_edges.first[0].positions_m[1], glm::vec3(-1, 0, 1));
  EXPECT_EQ(describe(c), "4 edges with one triangle only");
}

TEST(MeshCheck, ThreeTrianglesAtAnEdgeAreOneNonManifoldEdge) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0, 1}, {0, 0, 1, 1}, {1, 0, 0, 1}, {-1, 0, 0, 1}, {0, 1, 0, 1}};
  mesh.indices = {0, 1, 2, 1, 0, 3, 0, 1, 4};
  const MeshCheck c = check(mesh);
  EXPECT_EQ(c.non_manifold_edges.count, 1u);
  EXPECT_EQ(c.open_edges.count, 6u);
  EXPECT_EQ(c.misoriented_edges.count, 0u);
  EXPECT_THAT(c.non_manifold_edges.first[0].triangles, ElementsAre(0, 1, 2));
  EXPECT_THAT(c.non_manifold_edges.first[0].vertices, ElementsAre(0, 1));
}

TEST(MeshCheck, FlippedTriangleHasThreeMisorientedEdges) {
  Mesh mesh = test::icosphere_mesh(1.0f, 1);
  std::swap(mesh.indices[3 * 7 + 1], mesh.indices[3 * 7 + 2]);
  const MeshCheck c = check(mesh);
  EXPECT_EQ(c.misoriented_edges.count, 3u);
  EXPECT_EQ(c.open_edges.count + c.non_manifold_edges.count, 0u);
  for (const MeshPlace& place : c.misoriented_edges.first)
    EXPECT_THAT(place.triangles, testing::Contains(7u));
}

TEST(MeshCheck, DuplicateTriangleIsNamedWithItsFirst) {
  for (const bool reversed : {false, true}) {
    Mesh mesh = test::box_mesh(glm::vec3(1.0f));
    std::vector<std::uint32_t> copy(&mesh.indices[9], &mesh.indices[9] + 3);
    if (reversed) std::swap(copy[0], copy[1]);
    mesh.indices.insert(mesh.indices.end(), copy.begin(), copy.end());
    const MeshCheck c = check(mesh);
    ASSERT_EQ(c.duplicate_triangles.count, 1u);
    EXPECT_THAT(c.duplicate_triangles.first[0].triangles, ElementsAre(12, 3));
    EXPECT_EQ(c.non_manifold_edges.count, 3u);
  }
}

TEST(MeshCheck, CubeWithVerticesOfItsOwnForEachTriangleIsClosed) {
  const MeshCheck c = check(test::flat_box_mesh(glm::vec3(1.0f)));
  expect_no_faults_or_notes(c);
  EXPECT_EQ(c.vertices, 36u);
  EXPECT_EQ(c.repeated_vertices, 28u);
  EXPECT_EQ(c.welded_vertices, 8u);
}

TEST(MeshCheck, CubeWhoseTrianglesMissEachOtherByLessThanTheToleranceIsUnwelded) {
  Mesh mesh = test::flat_box_mesh(glm::vec3(1.0f));
  mesh.normals.clear();
  // Each vertex to a place of its own, at most 36 * 2e-7 m off; the tolerance is 3.5e-5 m.
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i].x += static_cast<float>(i) * 2e-7f;
  const MeshCheck c = check(mesh);
  EXPECT_EQ(c.open_edges.count, 36u);
  EXPECT_EQ(c.unwelded_vertices.count, 36u);
  EXPECT_EQ(check_mesh(*model_of(mesh), {.tolerance_m = 1e-9}).tolerance_m, 32.0 * 0x1p-23)
      << "no less than 32 steps of the largest coordinate";
}

TEST(MeshCheck, VertexInsideAnOpenEdgeIsATJunction) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  // One of the two triangles at an edge is cut at the edge's middle.
  const std::uint32_t a = mesh.indices[0], b = mesh.indices[1], c = mesh.indices[2];
  mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
  mesh.indices[1] = 8;
  mesh.indices.insert(mesh.indices.end(), {8, b, c});
  const MeshCheck found = check(mesh);
  EXPECT_EQ(found.open_edges.count, 3u);
  ASSERT_EQ(found.t_junctions.count, 1u);
  EXPECT_EQ(found.t_junctions.first[0].vertices[0], 8u);
  EXPECT_THAT((std::set<std::uint32_t>{found.t_junctions.first[0].vertices[1],
                                       found.t_junctions.first[0].vertices[2]}),
              testing::UnorderedElementsAre(a, b));
}

TEST(MeshCheck, DegenerateTrianglesAreThoseWithARepeatedCornerOrOnALine) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  mesh.indices.insert(mesh.indices.end(), {0, 0, 3});
  expect_no_faults_or_notes([&] {
    MeshCheck c = check(mesh);
    EXPECT_EQ(c.degenerate_triangles.count, 1u);
    EXPECT_THAT(c.degenerate_triangles.first[0].triangles, ElementsAre(12));
    c.degenerate_triangles = {};
    return c;
  }());
  Mesh line;
  line.positions = {{0, 0, 0, 1}, {1, 1, 1, 1}, {3, 3, 3, 1}};
  line.indices = {0, 1, 2};
  EXPECT_EQ(check(line).degenerate_triangles.count, 1u);
}

TEST(MeshCheck, VerticesThatAreNotFiniteOrNotUsedAreNamed) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  mesh.positions.push_back({5, 5, 5, 1});
  const MeshCheck unused = check(mesh);
  EXPECT_TRUE(unused.casts_classical_volume());
  EXPECT_THAT(unused.unreferenced_vertices.first.at(0).vertices, ElementsAre(8));
  mesh.positions[3].z = std::numeric_limits<float>::infinity();
  const MeshCheck infinite = check(mesh);
  EXPECT_FALSE(infinite.casts_classical_volume());
  EXPECT_THAT(infinite.non_finite_vertices.first.at(0).vertices, ElementsAre(3));
  EXPECT_THAT(describe(infinite), HasSubstr("1 vertex that is not finite"));
}

TEST(MeshCheck, BodiesThatShareOneVertexTouchAndStillCast) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  append(mesh, test::box_mesh(glm::vec3(1.0f)), glm::vec3(2.0f));
  const MeshCheck c = check(mesh);
  EXPECT_TRUE(c.casts_classical_volume());
  EXPECT_EQ(c.touching_vertices.count, 1u);
  EXPECT_EQ(c.touching_vertices.first.at(0).positions_m.at(0), glm::vec3(1.0f));
  EXPECT_EQ(c.pieces, 2u);
  EXPECT_EQ(c.welded_vertices, 15u);
}

TEST(MeshCheck, ClosedPieceThatFacesInwardsIsNoted) {
  Mesh mesh = test::box_mesh(glm::vec3(2.0f)), hollow = test::box_mesh(glm::vec3(1.0f));
  for (std::size_t i = 0; i < hollow.indices.size(); i += 3)
    std::swap(hollow.indices[i], hollow.indices[i + 1]);
  append(mesh, hollow);
  const MeshCheck c = check(mesh);
  EXPECT_TRUE(c.casts_classical_volume());
  ASSERT_EQ(c.inward_pieces.count, 1u);
  EXPECT_THAT(c.inward_pieces.first[0].triangles, ElementsAre(12));
}

TEST(MeshCheck, TrianglesThatCutEachOtherAreCountedAndThoseApartAreNot) {
  Mesh mesh;
  mesh.positions = {{-1, 0, 0, 1}, {1, 0, 0, 1}, {0, 2, 0, 1},
                    {0, 1, -1, 1}, {0, 1, 1, 1}, {0, 3, 0, 1}};
  mesh.indices = {0, 1, 2, 3, 4, 5};
  ASSERT_EQ(check(mesh).self_intersections.count, 1u);
  EXPECT_THAT(check(mesh).self_intersections.first[0].triangles, ElementsAre(0, 1));
  for (std::size_t i = 3; i < 6; ++i) mesh.positions[i].x += 5.0f;
  EXPECT_EQ(check(mesh).self_intersections.count, 0u);

  Mesh boxes = test::box_mesh(glm::vec3(1.0f));
  append(boxes, test::box_mesh(glm::vec3(1.0f)), {0.5f, 0.75f, 0.25f});
  EXPECT_GT(check(boxes).self_intersections.count, 0u);
  EXPECT_TRUE(check(boxes).casts_classical_volume()) << "a note only";
  EXPECT_FALSE(
      check_mesh(*model_of(boxes), {.self_intersections = false}).self_intersections_sought);
}

TEST(MeshCheck, TrianglesAndVerticesCountThroughTheParts) {
  Model model;
  model.parts.resize(2);
  model.parts[0].mesh = test::box_mesh(glm::vec3(1.0f));
  model.parts[1].mesh = test::square_mesh(5.0f);
  const MeshCheck c = check_mesh(model);
  EXPECT_THAT(c.open_edges.first.at(0).triangles, ElementsAre(12));
  EXPECT_THAT(c.open_edges.first.at(0).vertices, ElementsAre(8, 9));
}

TEST(MeshCheck, MeshWithoutATriangleCastsNothing) {
  EXPECT_FALSE(check_mesh(Model{}).casts_classical_volume());
  EXPECT_EQ(describe(check_mesh(Model{})), "no triangle with an area");
}

/// Triangles of a mesh of which no two share a vertex, in random order.
std::vector<std::uint32_t> scattered_triangles(const Mesh& mesh, std::mt19937& random,
                                               std::size_t count) {
  std::vector<std::uint32_t> scattered;
  std::set<std::uint32_t> used;
  for (int tries = 0; tries < 1000 && scattered.size() < count; ++tries) {
    const std::uint32_t t = test::below(random, mesh.triangle_count());
    const std::uint32_t* c = &mesh.indices[3 * t];
    if (used.contains(c[0]) || used.contains(c[1]) || used.contains(c[2])) continue;
    used.insert(c, c + 3);
    scattered.push_back(t);
  }
  return scattered;
}

// Oracle: what each defect adds to the counts of a closed mesh, where no two meet.
TEST(MeshCheck, RandomDefectsOfAClosedMeshAreEachCounted) {
  std::mt19937 random(20);
  for (int round = 0; round < 300; ++round) {
    Mesh mesh = round % 2 ? test::torus_mesh(0.5f, 0.2f, 24, 12) : test::icosphere_mesh(1.0f, 3);
    mesh.normals.clear();
    const std::vector<std::uint32_t> at = scattered_triangles(mesh, random, 12);
    std::size_t open = 0, non_manifold = 0, misoriented = 0, duplicate = 0, degenerate = 0,
                unused = 0;
    std::vector<std::uint32_t> removed;
    for (const std::uint32_t t : at) {
      const std::uint32_t a = mesh.indices[3 * t], b = mesh.indices[3 * t + 1],
                          c = mesh.indices[3 * t + 2];
      switch (test::below(random, 6)) {
        case 0:
          removed.push_back(t);
          open += 3;
          break;
        case 1:
          std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
          misoriented += 3;
          break;
        case 2:
          mesh.indices.insert(mesh.indices.end(), {b, c, a});
          non_manifold += 3;
          ++duplicate;
          break;
        case 3:  // a fin
          mesh.positions.emplace_back(2.0f * glm::vec3(mesh.positions[a]), 1.0f);
          mesh.indices.insert(mesh.indices.end(),
                              {a, b, static_cast<std::uint32_t>(mesh.positions.size() - 1)});
          ++non_manifold;
          open += 2;
          break;
        case 4:
          mesh.indices.insert(mesh.indices.end(), {a, b, b});
          ++degenerate;
          break;
        default:
          mesh.positions.push_back(mesh.positions[a]);
          ++unused;
      }
    }
    std::sort(removed.rbegin(), removed.rend());
    for (const std::uint32_t t : removed)
      mesh.indices.erase(mesh.indices.begin() + 3 * t, mesh.indices.begin() + 3 * t + 3);
    const MeshCheck c = check_mesh(*model_of(mesh), {.self_intersections = false});
    ASSERT_EQ(c.open_edges.count, open) << round;
    ASSERT_EQ(c.non_manifold_edges.count, non_manifold) << round;
    ASSERT_EQ(c.misoriented_edges.count, misoriented) << round;
    ASSERT_EQ(c.duplicate_triangles.count, duplicate) << round;
    ASSERT_EQ(c.degenerate_triangles.count, degenerate) << round;
    ASSERT_EQ(c.unreferenced_vertices.count, unused) << round;
    ASSERT_EQ(c.casts_classical_volume(), open + non_manifold + misoriented == 0) << round;
  }
}

}  // namespace
}  // namespace gnomon::pipeline
