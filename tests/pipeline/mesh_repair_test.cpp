// What repair_mesh mends. Oracles: check_mesh, the volume of bodies that are known, and the
// promise that no vertex moves by more than the tolerance.
#include "pipeline/mesh_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/mesh_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using test::model_of;

double volume_of(const Model& model) {
  double volume6 = 0.0;
  for (const Part& part : model.parts) {
    const auto at = [&](std::size_t i) {
      return glm::dvec3(part.mesh.positions[part.mesh.indices[i]]);
    };
    for (std::size_t i = 0; i < part.mesh.indices.size(); i += 3)
      volume6 += glm::dot(at(i), glm::cross(at(i + 1), at(i + 2)));
  }
  return volume6 / 6.0;
}

/// Every triangle as its three positions, from the smallest on in its winding; sorted.
std::vector<std::array<std::array<float, 3>, 3>> triangles_of(const Model& model) {
  std::vector<std::array<std::array<float, 3>, 3>> triangles;
  for (const Part& part : model.parts)
    for (std::size_t i = 0; i < part.mesh.indices.size(); i += 3) {
      std::array<std::array<float, 3>, 3> t{};
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec4& p = part.mesh.positions[part.mesh.indices[i + k]];
        t[k] = {p.x, p.y, p.z};
      }
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      triangles.push_back(t);
    }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Repairs and expects what holds of every result.
RepairedMesh repaired(const Model& model, const MeshRepairOptions& options = {}) {
  RepairedMesh out = repair_mesh(model, options);
  const MeshCheck after = check_mesh(out.model, {.self_intersections = false});
  EXPECT_EQ(after.non_manifold_edges.count, 0u);
  EXPECT_EQ(after.misoriented_edges.count, 0u);
  EXPECT_EQ(after.unreferenced_vertices.count, 0u);
  if (after.open_edges.count > 0) {
    EXPECT_GT(after.longest_outline, options.max_hole_edges);
  }
  EXPECT_LE(out.report.largest_move_m, out.report.tolerance_m);
  // A vertex of the result is one of the model's, or new. Those are told apart by the report.
  std::size_t far = 0;
  for (const Part& part : out.model.parts) {
    EXPECT_TRUE(part.mesh.normals.empty() ||
                part.mesh.normals.size() == part.mesh.positions.size());
    std::set<std::array<float, 3>> seen;
    for (const glm::vec4& p : part.mesh.positions) {
      if (!seen.insert({p.x, p.y, p.z}).second) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Part& from : model.parts)
        for (const glm::vec4& q : from.mesh.positions)
          nearest = std::min(nearest, glm::distance(glm::dvec3(p), glm::dvec3(q)));
      far += nearest > out.report.tolerance_m;
    }
  }
  EXPECT_LE(far, out.report.middle_vertices + out.report.closed_holes);
  return out;
}

RepairedMesh repaired(Mesh mesh, const MeshRepairOptions& options = {}) {
  return repaired(*model_of(std::move(mesh)), options);
}

bool is_closed(const Model& model) {
  return check_mesh(model, {.self_intersections = false}).casts_classical_volume();
}

void append(Mesh& to, const Mesh& from, const glm::vec3& by = glm::vec3(0.0f)) {
  const auto base = static_cast<std::uint32_t>(to.positions.size());
  for (const glm::vec4& p : from.positions) to.positions.push_back(p + glm::vec4(by, 0.0f));
  for (const std::uint32_t i : from.indices) to.indices.push_back(base + i);
  to.normals.clear();
}

void reverse(Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

TEST(MeshRepair, WhatIsFitKeepsItsBits) {
  for (const Mesh& mesh : {test::torus_mesh(0.5f, 0.2f, 24, 12), test::icosphere_mesh(1.0f, 2),
                           test::flat_box_mesh({1.0f, 2.0f, 3.0f})}) {
    const RepairedMesh out = repaired(mesh);
    EXPECT_EQ(triangles_of(out.model), triangles_of(*model_of(mesh)));
    EXPECT_EQ(out.report.largest_move_m, 0.0);
    EXPECT_EQ(out.report.turned_triangles, 0u);
    EXPECT_EQ(out.model.parts.at(0).mesh.normals.size(), mesh.normals.size());
  }
}

TEST(MeshRepair, FlippedTrianglesAreTurnedBack) {
  const Mesh torus = test::torus_mesh(0.5f, 0.2f, 24, 12);
  Mesh mesh = torus;
  for (const std::size_t t : {3u, 4u, 77u, 300u})
    std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(triangles_of(out.model), triangles_of(*model_of(torus)));
  EXPECT_EQ(out.report.turned_triangles, 4u);
  // The normals were right all the time.
  for (std::size_t v = 0; v < out.model.parts[0].mesh.positions.size(); ++v)
    EXPECT_GT(glm::length(out.model.parts[0].mesh.normals[v]), 0.9f);
}

TEST(MeshRepair, BodyInsideOutIsTurnedWithItsNormalsAndAHollowStays) {
  Mesh box = test::flat_box_mesh(glm::vec3(1.0f));
  reverse(box);
  for (glm::vec3& n : box.normals) n = -n;
  const RepairedMesh out = repaired(box);
  EXPECT_NEAR(volume_of(out.model), 8.0, 1e-6);
  for (std::size_t v = 0; v < out.model.parts[0].mesh.positions.size(); ++v)
    EXPECT_GT(glm::dot(out.model.parts[0].mesh.normals[v],
                       glm::vec3(out.model.parts[0].mesh.positions[v])),
              0.0f);

  Mesh shell = test::box_mesh(glm::vec3(2.0f)), hollow = test::box_mesh(glm::vec3(1.0f));
  reverse(hollow);
  append(shell, hollow);
  EXPECT_NEAR(volume_of(repaired(shell).model), 64.0 - 8.0, 1e-6);
  // Beside the shell the same piece is no hollow.
  Mesh beside = test::box_mesh(glm::vec3(2.0f));
  append(beside, hollow, {10, 0, 0});
  EXPECT_NEAR(volume_of(repaired(beside).model), 64.0 + 8.0, 1e-5);
}

TEST(MeshRepair, CrackedCubeIsWeldedToEightVertices) {
  Mesh mesh = test::flat_box_mesh(glm::vec3(1.0f));
  mesh.normals.clear();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.positions[i].x += static_cast<float>(i % 7) * 1e-6f;
  const RepairedMesh out = repaired(mesh);
  EXPECT_TRUE(is_closed(out.model));
  EXPECT_EQ(check_mesh(out.model).welded_vertices, 8u);
  EXPECT_GT(out.report.largest_move_m, 0.0);
  // Not with a smaller tolerance than the cracks are wide: the triangles stay apart, each is closed
  // with its own back.
  const RepairedMesh apart = repaired(mesh, {.tolerance_m = 0.0, .max_hole_edges = 0});
  EXPECT_FALSE(is_closed(apart.model));
}

TEST(MeshRepair, TJunctionIsCutWithoutMovingAnything) {
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  const std::uint32_t a = mesh.indices[0], b = mesh.indices[1], c = mesh.indices[2];
  mesh.positions.push_back(0.25f * mesh.positions[a] + 0.75f * mesh.positions[b]);
  mesh.indices[1] = 8;
  mesh.indices.insert(mesh.indices.end(), {8, b, c});
  const RepairedMesh out = repaired(mesh, {.max_hole_edges = 0});
  EXPECT_TRUE(is_closed(out.model));
  EXPECT_EQ(out.report.t_junctions, 1u);
  EXPECT_EQ(out.report.largest_move_m, 0.0);
  EXPECT_NEAR(volume_of(out.model), 8.0, 1e-6);
}

TEST(MeshRepair, TriangleOnALineGivesItsEdgeToTheNeighbour) {
  // As above, but the crack is filled with a triangle without area.
  Mesh mesh = test::box_mesh(glm::vec3(1.0f));
  const std::uint32_t a = mesh.indices[0], b = mesh.indices[1], c = mesh.indices[2];
  mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
  mesh.indices[1] = 8;
  mesh.indices.insert(mesh.indices.end(), {8, b, c, a, b, 8});
  ASSERT_TRUE(is_closed(*model_of(mesh)));
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(out.report.flat_triangles, 1u);
  EXPECT_EQ(check_mesh(out.model).degenerate_triangles.count, 0u);
  EXPECT_TRUE(is_closed(out.model));
  EXPECT_NEAR(volume_of(out.model), 8.0, 1e-6);
}

TEST(MeshRepair, DuplicatesAndCollapsedTrianglesGo) {
  const Mesh box = test::box_mesh(glm::vec3(1.0f));
  Mesh mesh = box;
  mesh.indices.insert(mesh.indices.end(),
                      {mesh.indices[4], mesh.indices[5], mesh.indices[3], 0, 1, 1});
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(out.report.duplicate_triangles, 1u);
  EXPECT_EQ(out.report.collapsed_triangles, 1u);
  EXPECT_EQ(triangles_of(out.model), triangles_of(*model_of(box)));
}

TEST(MeshRepair, TwoSidedBodyBecomesItsOutside) {
  const Mesh box = test::box_mesh(glm::vec3(1.0f));
  Mesh mesh = box, inner = box;
  reverse(inner);
  append(mesh, inner);
  const RepairedMesh out = repaired(mesh);
  EXPECT_EQ(triangles_of(out.model), triangles_of(*model_of(box)));
}

TEST(MeshRepair, BodiesThatShareAnEdgeOrAWallArePartedWithinTheTolerance) {
  for (const glm::vec3& by : {glm::vec3(2, 2, 0), glm::vec3(2, 0, 0)}) {
    Mesh mesh = test::box_mesh(glm::vec3(1.0f));
    append(mesh, test::box_mesh(glm::vec3(1.0f)), by);
    ASSERT_GT(check_mesh(*model_of(mesh)).non_manifold_edges.count, 0u);
    const RepairedMesh out = repaired(mesh);
    EXPECT_TRUE(is_closed(out.model));
    EXPECT_EQ(check_mesh(out.model).pieces, 2u);
    EXPECT_GT(out.report.parted_vertices, 0u);
    EXPECT_EQ(out.report.hole_triangles, 0u);
    EXPECT_NEAR(volume_of(out.model), 16.0, 1e-3);
    EXPECT_GT(out.report.largest_move_m, 0.0);
    EXPECT_LE(out.report.largest_move_m, out.report.tolerance_m / 16.0);
  }
}

TEST(MeshRepair, HolesUpToTheLimitAreClosedAndLongerOnesStay) {
  Mesh mesh = test::torus_mesh(0.5f, 0.2f, 24, 12);
  const double whole = volume_of(*model_of(mesh));
  mesh.indices.erase(mesh.indices.begin() + 60, mesh.indices.begin() + 72);  // four triangles
  const std::size_t edges = check_mesh(*model_of(mesh)).longest_outline;
  ASSERT_GT(edges, 4u);
  const RepairedMesh closed = repaired(mesh, {.max_hole_edges = edges});
  EXPECT_TRUE(is_closed(closed.model));
  EXPECT_EQ(closed.report.closed_holes, 1u);
  EXPECT_EQ(closed.report.hole_triangles, edges - 2);
  EXPECT_EQ(closed.report.largest_move_m, 0.0);
  EXPECT_NEAR(volume_of(closed.model), whole, 0.01 * whole);
  const RepairedMesh open = repaired(mesh, {.max_hole_edges = edges - 1});
  EXPECT_EQ(check_mesh(open.model).open_edges.count, edges);
  EXPECT_EQ(open.report.closed_holes, 0u);
}

TEST(MeshRepair, SheetGetsABack) {
  const RepairedMesh out = repaired(test::square_mesh(1.0f));
  EXPECT_TRUE(is_closed(out.model));
  EXPECT_NEAR(volume_of(out.model), 0.0, 1e-9);
}

TEST(MeshRepair, OneSidedSurfaceIsOpened) {
  // A Moebius strip of 20 quadrangles.
  Mesh mesh;
  constexpr std::uint32_t kAround = 20;
  const double turn = 2.0 * std::acos(-1.0);
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (const double side : {-0.3, 0.3}) {
      const double a = turn * i / kAround, r = 1.0 + side * std::cos(a / 2.0);
      mesh.positions.emplace_back(r * std::cos(a), r * std::sin(a), side * std::sin(a / 2.0), 1.0);
    }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1;
    const bool last = i + 1 == kAround;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : b + 2;
    mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
  }
  ASSERT_GT(check_mesh(*model_of(mesh)).misoriented_edges.count, 0u);
  const RepairedMesh out = repaired(mesh, {.max_hole_edges = 0});
  EXPECT_EQ(out.report.cut_edges, 1u);
  EXPECT_TRUE(is_closed(repaired(mesh, {.max_hole_edges = 100}).model));
}

TEST(MeshRepair, TriangleThatIsNotFiniteGoesAndItsHoleIsClosed) {
  Mesh mesh = test::icosphere_mesh(1.0f, 2);
  mesh.positions[40].y = std::numeric_limits<float>::quiet_NaN();
  const RepairedMesh out = repair_mesh(*model_of(mesh));
  EXPECT_TRUE(is_closed(out.model));
  EXPECT_EQ(out.report.non_finite_triangles, 6u);
}

TEST(MeshRepair, PartsKeepTheirMaterialsAndStayClosedTogether) {
  const Mesh box = test::box_mesh(glm::vec3(1.0f));
  Model model;
  model.parts.resize(2);
  for (Part& part : model.parts) part.mesh.positions = box.positions;
  model.parts[0].mesh.indices.assign(box.indices.begin(), box.indices.begin() + 15);
  model.parts[1].mesh.indices.assign(box.indices.begin() + 15, box.indices.end());
  model.parts[1].material.diffuse = {1, 0, 0};
  std::swap(model.parts[1].mesh.indices[0], model.parts[1].mesh.indices[1]);
  const RepairedMesh out = repaired(model);
  ASSERT_EQ(out.model.parts.size(), 2u);
  EXPECT_EQ(out.model.parts[1].material.diffuse, glm::vec3(1, 0, 0));
  EXPECT_EQ(out.model.parts[0].mesh.triangle_count(), 5u);
  EXPECT_EQ(triangles_of(out.model), triangles_of(*model_of(box)));
}

// Oracle: the closed mesh that the defects were put into: its volume, and that nothing moves.
TEST(MeshRepair, RandomDefectsOfAClosedMeshAreMended) {
  std::mt19937 random(21);
  for (int round = 0; round < 150; ++round) {
    Mesh mesh = round % 2 ? test::torus_mesh(0.5f, 0.2f, 24, 12) : test::icosphere_mesh(1.0f, 3);
    mesh.normals.clear();
    const double volume = volume_of(*model_of(mesh));
    const std::size_t defects = 1 + test::below(random, 12);
    for (std::size_t i = 0; i < defects; ++i) {
      const std::uint32_t t = test::below(random, mesh.triangle_count());
      const std::uint32_t a = mesh.indices[3 * t], b = mesh.indices[3 * t + 1],
                          c = mesh.indices[3 * t + 2];
      switch (test::below(random, 6)) {
        case 0:
          mesh.indices.erase(mesh.indices.begin() + 3 * t, mesh.indices.begin() + 3 * t + 3);
          break;
        case 1:
          std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
          break;
        case 2:
          mesh.indices.insert(mesh.indices.end(), {b, c, a});
          break;
        case 3:
          mesh.indices.insert(mesh.indices.end(), {a, b, b});
          break;
        case 4: {  // a crack: the corner gets a vertex of its own, a millionth beside
          mesh.positions.emplace_back(glm::vec3(mesh.positions[a]) * 1.000001f, 1.0f);
          mesh.indices[3 * t] = static_cast<std::uint32_t>(mesh.positions.size() - 1);
          break;
        }
        default:
          mesh.positions.push_back(mesh.positions[a]);
      }
    }
    const RepairedMesh out = repaired(mesh);
    ASSERT_TRUE(is_closed(out.model)) << round;
    ASSERT_NEAR(volume_of(out.model), volume, 0.02 * volume) << round;
    ASSERT_FALSE(HasFailure()) << round;
  }
}

// Oracle: the promise itself, for edges of any number of triangles in any direction.
TEST(MeshRepair, AnySoupBecomesAClosedSurface) {
  std::mt19937 random(22);
  std::size_t parted = 0, middles = 0;
  for (int round = 0; round < 1000; ++round) {
    const Mesh mesh = test::soup(random);
    const RepairedMesh out = repaired(mesh, {.max_hole_edges = kMaxHoleEdges});
    parted += out.report.parted_edges;
    middles += out.report.middle_vertices;
    ASSERT_TRUE(out.model.parts.empty() || is_closed(out.model)) << round;
    ASSERT_FALSE(HasFailure()) << round;
  }
  EXPECT_GT(parted, 1000u) << "the soups were too tame";
  EXPECT_GT(middles, 0u);
}

TEST(MeshRepair, SecondRepairFindsNothingToDo) {
  std::mt19937 random(23);
  for (int round = 0; round < 100; ++round) {
    const RepairedMesh once = repaired(test::soup(random), {.max_hole_edges = kMaxHoleEdges});
    if (once.model.parts.empty()) continue;
    const RepairedMesh twice = repaired(once.model);
    ASSERT_EQ(triangles_of(twice.model).size(), triangles_of(once.model).size()) << round;
    EXPECT_EQ(twice.report.parted_edges + twice.report.welded_vertices, 0u) << round;
  }
}

}  // namespace
}  // namespace gnomon::pipeline
