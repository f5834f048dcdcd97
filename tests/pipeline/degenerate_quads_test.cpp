#include "pipeline/degenerate_quads.h"

#include <array>
#include <cstdio>
#include <map>
#include <random>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/general_method.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr Extrusion kInfinite{.kind = Extrusion::Kind::infinite};

/// Directed edges between welded positions, moved or not, that are not run equally often both ways.
std::size_t open_edges(const DegenerateQuads& quads, const std::vector<bool>& moved) {
  using Vertex = std::pair<std::uint32_t, bool>;
  std::map<std::pair<Vertex, Vertex>, int> runs;
  const std::vector<std::uint32_t>& indices = *quads.indices;
  const auto vertex = [&](std::size_t i) {
    return Vertex{quads.positions[indices[i]], moved[indices[i] / 3]};
  };
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const Vertex from = vertex(i), to = vertex(i % 3 == 2 ? i - 2 : i + 1);
    if (from < to)
      ++runs[{from, to}];
    else if (to < from)
      --runs[{to, from}];
  }
  std::size_t open = 0;
  for (const auto& run : runs) open += run.second != 0;
  return open;
}

// Oracle: the definition of a closed chain, for triangles moved at random, by no light there is.
TEST(DegenerateQuads, AreClosedWhicheverTrianglesMove) {
  std::mt19937 random(2005);
  for (int i = 0; i < 200; ++i) {
    Model model;
    model.parts.push_back(
        {.mesh = i % 4 == 0 ? test::torus_mesh(0.5f, 0.2f, 8, 5) : test::soup(random)});
    const Topology topology = build_topology(model);
    for (const bool both_sides : {true, false}) {
      if (!both_sides && !topology.closed()) continue;
      const DegenerateQuads quads = add_degenerate_quads(topology, both_sides);
      std::vector<bool> moved(quads.positions.size() / 3);
      for (std::size_t t = 0; t < moved.size(); ++t) moved[t] = random() % 2 == 0;
      EXPECT_EQ(open_edges(quads, moved), 0u) << "mesh " << i;
    }
  }
}

// Closed form: a closed mesh of T triangles has 3 T / 2 edges, so T + 3 T triangles, and 3 T
// vertices.
TEST(DegenerateQuads, OfAClosedMeshAreOneAnEdge) {
  Model model;
  model.parts.push_back({.mesh = test::box_mesh(glm::vec3(1.0f))});
  const DegenerateQuads quads = add_degenerate_quads(build_topology(model), false);
  EXPECT_EQ(quads.positions.size(), 36u);
  EXPECT_EQ(quads.indices->size(), 3u * 48u);
  model.parts[0].mesh.indices.resize(30);
  EXPECT_THROW(add_degenerate_quads(build_topology(model), false), std::invalid_argument);
}

struct Comparison {
  std::size_t pixels = 0, counted = 0, different = 0;
};

/// The stencil of both geometries, both ways of drawing, at every pixel.
void compare(const Scene& scene, const Camera& camera, VolumeMethod method, VolumeMemory& memory,
             Comparison& sum) {
  VolumeOptions options{.method = method, .extrusion = kInfinite, .memory = &memory};
  const test::Counted expected = test::count_scene(scene, camera, options);
  options.geometry = VolumeGeometry::degenerate_quads;
  for (const bool single_sided : {false, true}) {
    const test::Counted counted =
        test::count_scene(scene, camera, options, {.single_sided = single_sided});
    const auto a = expected.stencil.to_rows(), b = counted.stencil.to_rows();
    for (std::size_t i = 0; i < a.size(); ++i) {
      ++sum.pixels;
      sum.counted += a[i] != 0;
      sum.different += a[i] != b[i];
    }
  }
}

Camera camera_anywhere(std::mt19937& random) {
  glm::vec3 eye = test::uniform_point(random, -3.0f, 3.0f);
  eye.y = test::uniform(random, 0.1f, 3.0f);
  return test::look(eye, test::uniform_point(random, -1.5f, 1.5f), kWidth, kHeight);
}

void report(const char* what, const Comparison& sum) {
  std::printf("%s: %zu of %zu stencil bytes differ, %zu are not 0\n", what, sum.different,
              sum.pixels, sum.counted);
}

TEST(DegenerateQuads, OfClosedBodiesCountWhatSilhouettesDo) {
  std::mt19937 random(2006);
  VolumeMemory memory;
  Comparison sum;
  for (int i = 0; i < 100; ++i) {
    Scene scene = test::random_scene(random);
    // By turns inside a body, which keeps the light in.
    if (i % 5 == 0)
      scene.lights[0].position = glm::vec4(glm::vec3(scene.objects[1].world_from_model[3]), 1.0f);
    compare(scene, camera_anywhere(random), i % 2 ? VolumeMethod::zpass : VolumeMethod::zfail,
            memory, sum);
  }
  report("closed bodies", sum);
  EXPECT_EQ(sum.different, 0u);
  EXPECT_GT(sum.counted, sum.pixels / 10);
}

/// Sheets and boxes without a side over a plate; on request triangle soups.
Scene open_scene(std::mt19937& random, bool with_soups) {
  Scene scene = test::random_scene(random);
  Mesh open_box = test::box_mesh({0.5f, 0.5f, 0.5f});
  open_box.indices.resize(30);
  for (std::size_t i = 1; i < scene.objects.size(); ++i)
    scene.objects[i].model = test::model_of(with_soups ? test::soup(random)
                                            : i % 2    ? test::square_mesh(0.6f)
                                                       : open_box);
  return scene;
}

TEST(DegenerateQuads, OfOpenMeshesCountWhatSilhouettesDo) {
  std::mt19937 random(2007);
  VolumeMemory memory;
  Comparison sum;
  for (int i = 0; i < 100; ++i)
    compare(open_scene(random, false), camera_anywhere(random),
            i % 2 ? VolumeMethod::zpass : VolumeMethod::zfail, memory, sum);
  report("open meshes", sum);
  EXPECT_EQ(sum.different, 0u);
  EXPECT_GT(sum.counted, sum.pixels / 10);
}

// Edges of any number of triangles, in any direction.
TEST(DegenerateQuads, OfSoupsCountWhatSilhouettesDo) {
  std::mt19937 random(2008);
  VolumeMemory memory;
  Comparison sum;
  for (int i = 0; i < 200; ++i)
    compare(open_scene(random, true), camera_anywhere(random),
            i % 2 ? VolumeMethod::zpass : VolumeMethod::zfail, memory, sum);
  report("soups", sum);
  EXPECT_EQ(sum.different, 0u);
  EXPECT_GT(sum.counted, sum.pixels / 10);
}

TEST(DegenerateQuads, KeepTheirIndicesFromLightToLight) {
  std::mt19937 random(2009);
  Scene scene = test::random_scene(random);
  const Camera camera = camera_anywhere(random);
  TopologyCache topologies;
  const std::vector<PlacedObject> objects = place_objects(scene, camera, topologies);
  VolumeMemory memory;
  const VolumeOptions options{
      .extrusion = kInfinite, .geometry = VolumeGeometry::degenerate_quads, .memory = &memory};
  const auto make = [&](const glm::vec4& position) {
    scene.lights[0].position = position;
    return make_volumes(objects, scene.lights[0], {}, {}, options);
  };
  const auto first = make({1.0f, 9.0f, 0.0f, 1.0f}), second = make({-4.0f, 8.0f, 3.0f, 1.0f});
  ASSERT_EQ(first.size(), scene.objects.size());
  ASSERT_EQ(second.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].volume->view().indices.data(), second[i].volume->view().indices.data());
    EXPECT_NE(first[i].volume->positions, second[i].volume->positions);
  }
}

TEST(DegenerateQuads, AreTheSameForEveryNumberOfThreads) {
  std::mt19937 random(2010);
  const Scene scene = test::random_scene(random);
  const Camera camera = camera_anywhere(random);
  std::vector<std::vector<std::uint8_t>> stencils;
  for (const int threads : {1, 2, 3, 7})
    stencils.push_back(
        test::count_scene(scene, camera,
                          {.geometry = VolumeGeometry::degenerate_quads, .threads = threads})
            .stencil.to_rows());
  for (const auto& stencil : stencils) EXPECT_EQ(stencil, stencils[0]);
}

// Finite volumes of a closed mesh end farther away, so only where nothing is seen.
TEST(DegenerateQuads, OfAutomaticLengthAgreeAtEveryVisibleReceiver) {
  std::mt19937 random(2011);
  std::size_t tested = 0, different = 0;
  for (int i = 0; i < 50; ++i) {
    const Scene scene = test::random_scene(random);
    const Camera camera = camera_anywhere(random);
    const test::Counted a = test::count_scene(scene, camera, {.method = VolumeMethod::zfail});
    const test::Counted b = test::count_scene(
        scene, camera,
        {.method = VolumeMethod::zfail, .geometry = VolumeGeometry::degenerate_quads});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (a.depth.at(x, y) == a.depth.max_value()) continue;
        ++tested;
        different += a.stencil.at(x, y) != b.stencil.at(x, y);
      }
    }
  }
  EXPECT_EQ(different, 0u);
  EXPECT_GT(tested, 1000000u);
}

// Oracle: the two-sided draws. Modulo 256 the order of steps has no say.
TEST(CountVolumes, SingleSidedWithWrappingEqualsTwoSided) {
  std::mt19937 random(2012);
  std::size_t counted = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene scene = i % 2 ? open_scene(random, true) : test::random_scene(random);
    const Camera camera = camera_anywhere(random);
    for (const VolumeMethod method : {VolumeMethod::zpass, VolumeMethod::zfail}) {
      const VolumeOptions options{.method = method};
      const auto two_sided = test::count_scene(scene, camera, options).stencil.to_rows();
      EXPECT_EQ(test::count_scene(scene, camera, options, {.single_sided = true}).stencil.to_rows(),
                two_sided);
      for (const std::uint8_t value : two_sided) counted += value != 0;
    }
  }
  EXPECT_GT(counted, 100000u);
}

}  // namespace
}  // namespace gnomon::pipeline
