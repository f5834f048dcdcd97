#include "pipeline/shadow_volume.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/count_volumes.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using test::model_of;
using test::uniform;

/// Directed edges that are not cancelled by their opposite.
std::size_t open_edges(const ShadowVolume& volume) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (std::size_t i = 0; i < volume.indices.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = volume.indices[i + k], b = volume.indices[i + (k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, sum] : balance) open += sum != 0;
  return open;
}

/// Volume that the triangles bound, by the divergence theorem.
double enclosed(const ShadowVolume& volume) {
  double sum = 0.0;
  for (std::size_t i = 0; i < volume.indices.size(); i += 3) {
    const glm::dvec3 a(volume.positions[volume.indices[i]]),
        b(volume.positions[volume.indices[i + 1]]), c(volume.positions[volume.indices[i + 2]]);
    sum += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  return sum;
}

struct Cast {
  Topology topology;
  glm::dvec4 light;
  Silhouette silhouette;
};

Cast cast(const Mesh& mesh, const glm::vec4& light, const glm::mat4& world = glm::mat4(1.0f)) {
  Cast result{build_topology(*model_of(mesh)), light_in_model(light, world), {}};
  result.silhouette = find_silhouette(result.topology, result.light);
  return result;
}

// Oracle: the boundary of a boundary is nothing.
TEST(ShadowVolume, IsAClosedChainForClosedOpenAndNonManifoldMeshes) {
  std::mt19937 random(7);
  std::vector<Mesh> meshes = {test::box_mesh(glm::vec3(0.5f)), test::torus_mesh(0.6f, 0.2f, 12, 8),
                              test::icosphere_mesh(0.7f, 1), test::square_mesh(0.8f)};
  for (int i = 0; i < 200; ++i) meshes.push_back(test::soup(random));
  std::size_t volumes = 0;
  for (const Mesh& mesh : meshes) {
    for (const float w : {0.0f, 1.0f}) {
      const Cast c = cast(mesh, {uniform(random, -2, 2), 2.0f, uniform(random, -2, 2), w});
      for (const ShadowVolume& volume :
           {extrude_to_infinity(c.topology, c.silhouette, c.light),
            extrude_by(c.topology, c.silhouette, c.light, 3.0),
            extrude_by_radius(c.topology, c.silhouette, c.light, glm::mat4(1.0f), 2.0)}) {
        EXPECT_EQ(open_edges(volume), 0u);
        volumes += !volume.empty();
      }
    }
  }
  EXPECT_GT(volumes, 1000u);
}

// Oracle: the prism over the 2 x 2 top face, 3 m long, holds 12 m^3.
TEST(ShadowVolume, OfACubeFromAboveHoldsThePrismUnderItsTopFace) {
  const Cast c = cast(test::box_mesh(glm::vec3(1.0f)), {0.0f, 1.0f, 0.0f, 0.0f});
  const ShadowVolume volume = extrude_by(c.topology, c.silhouette, c.light, 3.0);
  EXPECT_EQ(volume.indices.size(), 3u * (2 + 8 + 2));
  EXPECT_EQ(volume.front_cap_indices, 6u);
  EXPECT_EQ(volume.side_indices, 24u);
  EXPECT_NEAR(enclosed(volume), 12.0, 1e-5);
}

// Oracle: frustum between the top face and its image twice as far: (2^3 - 1) pyramids of 4 * 2 / 3.
TEST(ShadowVolume, OfACubeFromAPointHoldsTheFrustum) {
  const Cast c = cast(test::box_mesh(glm::vec3(1.0f)), {0.0f, 3.0f, 0.0f, 1.0f});
  EXPECT_NEAR(enclosed(extrude_by(c.topology, c.silhouette, c.light, 2.0)), 7.0 * 8.0 / 3.0, 1e-4);
}

TEST(ShadowVolume, RadiusIsInMetresOfTheWorld) {
  const glm::mat4 world = test::placed({1, 0, 2}, {1, 2, 3}, 1.0f, {0.1f, 3.0f, 0.5f});
  for (const float w : {0.0f, 1.0f}) {
    const glm::vec4 light(0.5f, 8.0f, 1.0f, w);
    const Cast c = cast(test::torus_mesh(0.6f, 0.2f, 12, 8), light, world);
    const ShadowVolume volume = extrude_by_radius(c.topology, c.silhouette, c.light, world, 2.5);
    // Sides come as (to, from, from') triangles: the second and third corner lie on one ray.
    for (std::size_t i = 0; i < volume.side_indices; i += 6) {
      const std::size_t at = volume.front_cap_indices + i;
      const glm::vec3 near(world * volume.positions[volume.indices[at + 1]]);
      const glm::vec3 far(world * volume.positions[volume.indices[at + 2]]);
      EXPECT_NEAR(glm::distance(near, far), 2.5f, 1e-4f);
      const glm::vec3 ray = w == 0.0f ? -glm::vec3(light) : near - glm::vec3(light);
      EXPECT_NEAR(glm::dot(glm::normalize(far - near), glm::normalize(ray)), 1.0f, 1e-5f);
    }
  }
}

/// The corners of a range of indices, as positions.
std::vector<glm::vec4> corners(const raster::MeshView& mesh) {
  std::vector<glm::vec4> result;
  for (const std::uint32_t index : mesh.indices) result.push_back(mesh.positions[index]);
  return result;
}

// Oracle: the volume with both caps, range by range.
TEST(ShadowVolume, WithoutACapHasTheOtherTrianglesToTheBit) {
  std::mt19937 random(70);
  std::vector<Mesh> meshes = {test::torus_mesh(0.6f, 0.2f, 12, 8), test::square_mesh(0.8f)};
  for (int i = 0; i < 50; ++i) meshes.push_back(test::soup(random));
  // One builder and one volume for all: what one mesh leaves there does not reach the next.
  VolumeBuilder builder;
  ShadowVolume volume;
  for (const Mesh& mesh : meshes) {
    for (const float w : {0.0f, 1.0f}) {
      const Cast c = cast(mesh, {uniform(random, -2, 2), 2.0f, uniform(random, -2, 2), w});
      const std::vector<glm::vec4> all =
          corners(extrude_to_infinity(c.topology, c.silhouette, c.light).view());
      for (const Caps caps : {Caps{true, true}, {true, false}, {false, true}, {false, false}}) {
        builder.extrude_to_infinity(c.topology, c.silhouette, c.light, caps, volume);
        std::vector<glm::vec4> expected = all;
        const auto begin = expected.begin();
        const auto cap = static_cast<std::ptrdiff_t>(
            extrude_to_infinity(c.topology, c.silhouette, c.light).front_cap_indices);
        const auto sides = static_cast<std::ptrdiff_t>(volume.side_indices);
        if (!caps.back) expected.erase(begin + cap + sides, expected.end());
        std::vector<glm::vec4> without_front(begin + cap, expected.end());
        if (!caps.front) expected = without_front;
        ASSERT_EQ(corners(volume.view()), expected);
        ASSERT_EQ(corners(volume.view_without_front_cap()), without_front);
      }
    }
  }
}

TEST(ShadowVolume, FrontCapHasTheBitsOfTheMesh) {
  const Mesh mesh = test::torus_mesh(0.6f, 0.2f, 12, 8);
  const Cast c = cast(mesh, {0.5f, 8.0f, 1.0f, 1.0f});
  const ShadowVolume volume = extrude_by(c.topology, c.silhouette, c.light, 2.0);
  std::size_t at = 0;
  for (std::size_t t = 0; t < c.silhouette.casting.size(); ++t) {
    if (c.silhouette.casting[t] == 0) continue;
    for (std::size_t k = 0; k < 3; ++k, ++at) {
      EXPECT_EQ(volume.positions[volume.indices[at]], mesh.positions[mesh.indices[3 * t + k]]);
    }
  }
  EXPECT_EQ(at, volume.front_cap_indices);
}

TEST(ShadowVolume, InfiniteBackCapOfADirectionFallsAwayAndThatOfAPointDoesNot) {
  const Mesh box = test::box_mesh(glm::vec3(1.0f));
  const Cast sun = cast(box, {0.0f, 1.0f, 0.0f, 0.0f});
  const ShadowVolume to_one_point = extrude_to_infinity(sun.topology, sun.silhouette, sun.light);
  EXPECT_EQ(to_one_point.indices.size(), 3u * (2 + 4));
  const Cast lamp = cast(box, {0.0f, 3.0f, 0.0f, 1.0f});
  const ShadowVolume capped = extrude_to_infinity(lamp.topology, lamp.silhouette, lamp.light);
  EXPECT_EQ(capped.indices.size(), 3u * (2 + 8 + 2));
  for (const glm::vec4& p : capped.positions) EXPECT_TRUE(p.w == 1.0f || p.w == 0.0f);
}

}  // namespace
}  // namespace gnomon::pipeline
