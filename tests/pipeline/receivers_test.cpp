#include "pipeline/receivers.h"

#include <algorithm>
#include <optional>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/count_volumes.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using test::model_of;
using test::uniform;

std::vector<WorldTriangle> world_triangles(const Mesh& mesh, const glm::mat4& world) {
  std::vector<WorldTriangle> triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    WorldTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = glm::dvec3(glm::dmat4(world) * glm::dvec4(mesh.positions[mesh.indices[i + k]]));
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

CastingMesh casting_mesh(const std::vector<WorldTriangle>& triangles) {
  CastingMesh mesh;
  for (const WorldTriangle& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.corners.size());
    mesh.corners.insert(mesh.corners.end(), triangle.begin(), triangle.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Where the line from `origin` along `direction` crosses the triangle, in units of `direction`.
std::optional<double> crossing(const glm::dvec3& origin, const glm::dvec3& direction,
                               const WorldTriangle& triangle) {
  const glm::dvec3 e1 = triangle[1] - triangle[0], e2 = triangle[2] - triangle[0];
  const glm::dvec3 p = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, p);
  if (determinant == 0.0) return std::nullopt;
  const glm::dvec3 s = origin - triangle[0];
  const double u = glm::dot(s, p) / determinant;
  const glm::dvec3 q = glm::cross(s, e1);
  const double v = glm::dot(direction, q) / determinant;
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return std::nullopt;
  return glm::dot(e2, q) / determinant;
}

glm::dvec3 point_on(const WorldTriangle& triangle, std::mt19937& random) {
  double u = uniform(random, 0.0f, 1.0f), v = uniform(random, 0.0f, 1.0f);
  if (u + v > 1.0) {
    u = 1.0 - u;
    v = 1.0 - v;
  }
  return triangle[0] + u * (triangle[1] - triangle[0]) + v * (triangle[2] - triangle[0]);
}

// Oracle: for random receiver points in the infinite volume, the sweep that a direct intersection
// of the light's ray with the caster asks for.
TEST(Reach, ContainsEveryReceiverPointOfTheInfiniteVolume) {
  std::mt19937 random(11);
  std::size_t inside = 0;
  double tightest = 1e9;
  for (int round = 0; round < 300; ++round) {
    const Scene scene = test::random_scene(random);
    const glm::vec4 light = scene.lights[0].position;
    const Receivers receivers(scene);
    const Object& object = scene.objects[1 + random() % (scene.objects.size() - 1)];
    const Mesh& mesh = object.model->parts[0].mesh;
    const std::vector<WorldTriangle> caster = world_triangles(mesh, object.world_from_model);
    const Reach reach = find_reach(light, casting_mesh(caster), receivers);
    ASSERT_EQ(reach.kind, Reach::Kind::finite);
    for (int sample = 0; sample < 300; ++sample) {
      const Receivers::Group& group = receivers.groups()[random() % receivers.groups().size()];
      const glm::dvec3 p = point_on(group.triangles[random() % group.triangles.size()], random);
      const glm::dvec3 from = light.w == 0.0f ? p : glm::dvec3(light);
      const glm::dvec3 along = light.w == 0.0f ? glm::dvec3(light) : p - glm::dvec3(light);
      double needed = -1.0;
      for (const WorldTriangle& triangle : caster) {
        const auto t = crossing(from, along, triangle);
        if (!t) continue;
        if (light.w == 0.0f && *t > 0.0) needed = std::max(needed, *t);
        if (light.w != 0.0f && *t > 0.0 && *t <= 1.0) needed = std::max(needed, 1.0 / *t);
      }
      if (needed < 0.0) continue;
      ++inside;
      EXPECT_LE(needed, reach.amount);
      tightest = std::min(tightest, reach.amount / std::max(needed, 1e-9));
    }
  }
  EXPECT_GT(inside, 3000u);
  RecordProperty("receiver_points_inside", static_cast<int>(inside));
  std::printf("receiver points inside infinite volumes: %zu, tightest reach / needed: %.4f\n",
              inside, tightest);
}

// Oracle: the same receivers triangle by triangle, in another order. What is passed over because
// something else reaches farther may not be missed.
TEST(Reach, IsTheSameToTheBitHoweverReceiversAreGroupedAndOrdered) {
  std::mt19937 random(12);
  std::size_t finite = 0;
  for (int round = 0; round < 60; ++round) {
    Scene scene = test::random_scene(random);
    if (round % 2) scene.objects.erase(scene.objects.begin());
    const glm::vec4 light = scene.lights[0].position;
    std::vector<std::pair<Mesh, glm::mat4>> pieces;
    for (const Object& object : scene.objects) {
      const Mesh& mesh = object.model->parts[0].mesh;
      for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        Mesh piece{.positions = mesh.positions};
        piece.indices.assign(mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                             mesh.indices.begin() + static_cast<std::ptrdiff_t>(i) + 3);
        pieces.emplace_back(std::move(piece), object.world_from_model);
      }
    }
    for (std::size_t i = pieces.size(); i > 1; --i) {
      std::swap(pieces[i - 1], pieces[test::below(random, i)]);
    }
    Receivers apart;
    for (const auto& [mesh, world] : pieces) apart.add(*model_of(mesh), world);
    const Receivers together(scene);
    for (const Object& object : scene.objects) {
      const CastingMesh caster =
          casting_mesh(world_triangles(object.model->parts[0].mesh, object.world_from_model));
      const Reach reach = find_reach(light, caster, together);
      EXPECT_EQ(find_reach(light, caster, apart), reach);
      finite += reach.kind == Reach::Kind::finite;
    }
  }
  EXPECT_GT(finite, 150u);
}

// Oracle: a plate 4 m under the light and parallel to the square 1 m under it: factor 4, plus the
// margin.
TEST(Reach, IsTightForAParallelPlate) {
  Receivers receivers;
  receivers.add(*model_of(test::square_mesh(50.0f)), test::placed({0, -4, 0}));
  const auto caster = world_triangles(test::square_mesh(0.5f), test::placed({0, -1, 0}));
  const Reach point = find_reach({0, 0, 0, 1}, casting_mesh(caster), receivers);
  EXPECT_NEAR(point.amount, 4.0 * (1.0 + kReachMargin), 1e-4);
  const Reach sun = find_reach({0, 1, 0, 0}, casting_mesh(caster), receivers);
  EXPECT_NEAR(sun.amount, 3.0 * (1.0 + kReachMargin), 1e-4);
}

TEST(Reach, IgnoresReceiversOutsideThePyramidAndBeforeTheCaster) {
  Receivers receivers;
  receivers.add(*model_of(test::square_mesh(1.0f)), test::placed({60, -90, 0}));
  receivers.add(*model_of(test::square_mesh(0.1f)), test::placed({0, -0.5f, 0}));
  const auto caster = world_triangles(test::square_mesh(0.5f), test::placed({0, -1, 0}));
  EXPECT_EQ(find_reach({0, 0, 0, 1}, casting_mesh(caster), receivers).kind, Reach::Kind::none);
  EXPECT_EQ(find_reach({0, 1, 0, 0}, casting_mesh(caster), receivers).kind, Reach::Kind::none);
}

TEST(Reach, LightOnTheCasterHasNoFiniteReach) {
  Receivers receivers;
  receivers.add(*model_of(test::square_mesh(9.0f)), test::placed({0, -4, 0}));
  const auto caster = world_triangles(test::square_mesh(0.5f), glm::mat4(1.0f));
  EXPECT_EQ(find_reach({0, 1e-5f, 0, 1}, casting_mesh(caster), receivers).kind,
            Reach::Kind::unbounded);
}

// Oracle: the definition; a light among the caster's parts sees receivers all round.
TEST(Reach, LightInsideTheCastersBoundsCountsAllReceivers) {
  Receivers receivers;
  receivers.add(*model_of(test::square_mesh(1.0f)), test::placed({0, -20, 0}));
  std::vector<WorldTriangle> ring =
      world_triangles(test::torus_mesh(2.0f, 0.2f, 16, 8), glm::mat4(1.0f));
  const Reach reach = find_reach({0, 0, 0, 1}, casting_mesh(ring), receivers);
  EXPECT_EQ(reach.kind, Reach::Kind::finite);
  EXPECT_GT(reach.amount, 20.0 / 2.2);
}

}  // namespace
}  // namespace gnomon::pipeline
