// What simplify_mesh promises. Oracles: bodies whose distance to their simplification has a closed
// form, and check_mesh.
#include "pipeline/mesh_simplify.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/mesh_check.h"
#include "pipeline/surface_distance.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using test::model_of;

bool is_closed(const Model& model) {
  return check_mesh(model, {.self_intersections = false}).casts_classical_volume();
}

TEST(SurfaceDistance, IsTheGapOfParallelSquaresAndZeroForTheSame) {
  const auto square = model_of(test::square_mesh(1.0f));
  Mesh lifted = test::square_mesh(1.0f);
  for (glm::vec4& p : lifted.positions) p.y += 0.25f;
  EXPECT_NEAR(surface_distance(*square, *model_of(lifted)), 0.25, 1e-12);
  EXPECT_EQ(surface_distance(*square, *square), 0.0);
  EXPECT_EQ(surface_distance(*square, Model{}), 0.0);
}

TEST(SurfaceDistance, LooksFromBothSides) {
  // The small square lies in the large one; the large one's corners are sqrt(2) from it.
  const auto small = model_of(test::square_mesh(1.0f)), large = model_of(test::square_mesh(2.0f));
  EXPECT_NEAR(surface_distance(*small, *large), std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(surface_distance(*large, *small), std::numbers::sqrt2, 1e-12);
}

TEST(SurfaceDistance, SeesTheInsideOfTriangles) {
  // A roof over a square, seen from the square's side only at its middle.
  Mesh roof;
  roof.positions = {{-1, 0, -1, 1}, {-1, 0, 1, 1}, {1, 0, 1, 1}, {1, 0, -1, 1}, {0, 0.5f, 0, 1}};
  roof.indices = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
  EXPECT_NEAR(surface_distance(*model_of(test::square_mesh(1.0f)), *model_of(roof)), 0.5, 1e-12);
}

TEST(MeshSimplify, PixelsBecomeMetresByTheCamera) {
  // A right angle sees 2 m at 1 m.
  const double right_angle = std::numbers::pi / 2.0;
  EXPECT_NEAR(metres_of_pixels(0.5, 1.0, right_angle, 1000.0), 0.001, 1e-15);
  EXPECT_NEAR(metres_of_pixels(1.0, 3.0, right_angle, 600.0), 0.01, 1e-15);
}

// Oracle: points of a simplified sphere lie between the spheres of radius 1 - error and 1.
TEST(MeshSimplify, SphereStaysClosedWithinTheError) {
  const auto sphere = model_of(test::icosphere_mesh(1.0f, 4));
  std::size_t before = 5120;
  for (const double error_m : {0.003, 0.01, 0.03, 0.1}) {
    const SimplifiedMesh out = simplify_mesh(*sphere, error_m);
    EXPECT_TRUE(is_closed(out.model)) << error_m;
    EXPECT_FALSE(out.report.given_up);
    EXPECT_LT(out.report.triangles_after, before) << error_m;
    before = out.report.triangles_after;
    EXPECT_LE(out.report.measured_error_m, error_m);
    EXPECT_EQ(out.report.measured_error_m, surface_distance(*sphere, out.model));
    const Mesh& mesh = out.model.parts.at(0).mesh;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      glm::dvec3 middle(0.0);
      for (std::size_t k = 0; k < 3; ++k)
        middle += glm::dvec3(mesh.positions[mesh.indices[i + k]]) / 3.0;
      // The sphere of 5120 triangles is itself up to 0.0021 m flatter than the round one.
      EXPECT_GE(glm::length(middle), 1.0 - error_m - 0.0021);
    }
  }
}

TEST(MeshSimplify, KeepsNormalsOfTheVerticesThatStay) {
  const SimplifiedMesh out = simplify_mesh(*model_of(test::icosphere_mesh(1.0f, 4)), 0.01);
  const Mesh& mesh = out.model.parts.at(0).mesh;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    EXPECT_NEAR(glm::dot(mesh.normals[v], glm::vec3(mesh.positions[v])), 1.0f, 1e-5f);
}

TEST(MeshSimplify, EdgesOfAFinelyCutBoxStaySharp) {
  // Each side of the box cut in 2 * 16 * 16 triangles: 12 are enough for any error.
  Mesh mesh;
  constexpr int kCuts = 16;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      const auto base = static_cast<std::uint32_t>(mesh.positions.size());
      for (int i = 0; i <= kCuts; ++i)
        for (int j = 0; j <= kCuts; ++j) {
          glm::vec4 p(0, 0, 0, 1);
          glm::vec3 n(0.0f);
          p[axis] = n[axis] = side;
          p[(axis + 1) % 3] = static_cast<float>(i) / (kCuts / 2) - 1.0f;
          p[(axis + 2) % 3] = static_cast<float>(j) / (kCuts / 2) - 1.0f;
          mesh.positions.push_back(p);
          mesh.normals.push_back(n);
        }
      for (std::uint32_t i = 0; i < kCuts; ++i)
        for (std::uint32_t j = 0; j < kCuts; ++j) {
          const std::uint32_t a = base + i * (kCuts + 1) + j, b = a + kCuts + 1;
          if (side > 0)
            mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
          else
            mesh.indices.insert(mesh.indices.end(), {a, b + 1, b, a, a + 1, b + 1});
        }
    }
  ASSERT_TRUE(is_closed(*model_of(mesh)));
  const SimplifiedMesh out = simplify_mesh(*model_of(mesh), 0.001);
  EXPECT_TRUE(is_closed(out.model));
  EXPECT_EQ(out.report.triangles_after, 12u);
  const Mesh& box = out.model.parts.at(0).mesh;
  for (const glm::vec3& n : box.normals)
    EXPECT_EQ(std::abs(n.x) + std::abs(n.y) + std::abs(n.z), 1.0f) << "of one side alone";
}

TEST(MeshSimplify, PartsStillMeet) {
  const Mesh torus = test::torus_mesh(0.5f, 0.2f, 96, 48);
  Model model;
  model.parts.resize(2);
  for (Part& part : model.parts) part.mesh.positions = torus.positions;
  const auto half = static_cast<std::ptrdiff_t>(torus.indices.size() / 2 / 3 * 3);
  model.parts[0].mesh.indices.assign(torus.indices.begin(), torus.indices.begin() + half);
  model.parts[1].mesh.indices.assign(torus.indices.begin() + half, torus.indices.end());
  ASSERT_TRUE(is_closed(model));
  const SimplifiedMesh out = simplify_mesh(model, 0.005);
  EXPECT_EQ(out.model.parts.size(), 2u);
  EXPECT_TRUE(is_closed(out.model));
  EXPECT_LT(out.report.triangles_after, torus.triangle_count() / 2);
}

// Oracle: the promise, over bodies of many shapes; closed comes back closed.
TEST(MeshSimplify, ClosedMeshesStayClosedAtEveryError) {
  std::mt19937 random(24);
  for (int round = 0; round < 40; ++round) {
    Mesh mesh = round % 2 ? test::torus_mesh(0.5f, 0.24f, 40, 20) : test::icosphere_mesh(1.0f, 3);
    mesh.normals.clear();
    // Dents and horns.
    for (glm::vec4& p : mesh.positions)
      p = glm::vec4(glm::vec3(p) * test::uniform(random, 0.9f, 1.1f), 1.0f);
    ASSERT_TRUE(is_closed(*model_of(mesh)));
    const double error_m = test::uniform(random, 0.005f, 0.3f);
    const SimplifiedMesh out = simplify_mesh(*model_of(mesh), error_m);
    ASSERT_TRUE(is_closed(out.model)) << round;
    ASSERT_LE(surface_distance(*model_of(mesh), out.model), error_m) << round;
  }
}

TEST(MeshSimplify, OpenOutlineKeepsItsEdges) {
  Mesh mesh = test::icosphere_mesh(1.0f, 4);
  mesh.indices.resize(mesh.indices.size() / 2);
  const MeshCheck before = check_mesh(*model_of(mesh));
  const SimplifiedMesh out = simplify_mesh(*model_of(mesh), 0.01);
  const MeshCheck after = check_mesh(out.model);
  EXPECT_GT(before.open_edges.count, 0u);
  EXPECT_EQ(after.open_edges.count, before.open_edges.count);
  EXPECT_LT(after.triangles, before.triangles);
}

}  // namespace
}  // namespace gnomon::pipeline
