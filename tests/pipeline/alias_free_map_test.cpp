// Alias-free maps against an independent ray-cast (Embree, robust mode).
#include "pipeline/alias_free_map.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "pipeline/general_method.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kScenes = 100;
constexpr int kWidth = 320, kHeight = 240;

/// Depth, and the stencil that the mask of the scene's first light leaves.
test::Counted draw_hidden(const Scene& scene, const Camera& camera, AliasFreeMemory& memory,
                          int threads = 0) {
  test::Counted drawn{raster::DepthBuffer(camera.width, camera.height),
                      raster::StencilBuffer(camera.width, camera.height)};
  TopologyCache topologies;
  const std::vector<PlacedObject> objects = place_objects(scene, camera, topologies);
  memory.finder.find(objects, camera, camera.width, camera.height, raster::DepthFormat::d24,
                     threads);
  const auto hidden =
      find_hidden(objects, Casters(scene), camera, scene.lights[0], threads, memory);
  raster::Frame frame;
  frame.begin_pass("surfaces", {.depth = &drawn.depth, .stencil = &drawn.stencil});
  frame.clear({.depth = 1.0f, .stencil = 0});
  raster::State state = surface_state();
  state.depth = raster::DepthState{};
  for (const PlacedObject& object : objects) draw_depth(frame, object, state);
  stencil_hidden(frame, hidden, camera.width, camera.height, "hidden");
  raster::execute(frame);
  return drawn;
}

struct Sum {
  test::Disagreement rays;
  std::size_t shadowed = 0;
};

void add(Sum& sum, const Scene& scene, const Camera& camera, AliasFreeMemory& memory) {
  const test::Counted drawn = draw_hidden(scene, camera, memory);
  for (const std::uint8_t value : drawn.stencil.to_rows()) sum.shadowed += value != 0;
  sum.rays += test::compare_with_rays(drawn, scene, RayReference(scene), camera);
}

void report(const char* what, const Sum& sum) {
  std::printf(
      "%s: %zu pixels tested (%zu in shadow), %zu wrong: %zu at an edge, %zu depth ties, "
      "%zu unexplained\n",
      what, sum.rays.tested, sum.shadowed, sum.rays.wrong, sum.rays.at_edge, sum.rays.depth_tie,
      sum.rays.unexplained);
}

Camera camera_anywhere(std::mt19937& random) {
  glm::vec3 eye = test::uniform_point(random, -3.0f, 3.0f);
  eye.y = test::uniform(random, 0.1f, 3.0f);
  return test::look(eye, test::uniform_point(random, -1.5f, 1.5f), kWidth, kHeight);
}

TEST(AliasFreeMap, OfClosedBodiesDiffersFromTheRaysOnlyAtEdgesAndTies) {
  std::mt19937 random(2005);
  AliasFreeMemory memory;
  Sum sum;
  for (int i = 0; i < kScenes; ++i) {
    const Scene scene = test::random_scene(random);
    add(sum, scene, camera_anywhere(random), memory);
  }
  report("closed bodies", sum);
  EXPECT_EQ(sum.rays.unexplained, 0u);
  EXPECT_LT(sum.rays.wrong, sum.rays.tested / 1000);
  EXPECT_GT(sum.shadowed, sum.rays.tested / 20);
}

/// Open sheets, boxes without a side and soups over a plate.
Scene open_scene(std::mt19937& random) {
  Scene scene = test::random_scene(random);
  Mesh open_box = test::box_mesh({0.5f, 0.5f, 0.5f});
  open_box.indices.resize(30);
  const std::array<std::shared_ptr<const Model>, 3> models = {
      test::model_of(test::square_mesh(0.6f)), test::model_of(open_box),
      test::model_of(test::soup(random))};
  for (std::size_t i = 1; i < scene.objects.size(); ++i) scene.objects[i].model = models[i % 3];
  return scene;
}

TEST(AliasFreeMap, OfOpenMeshesDiffersFromTheRaysOnlyAtEdgesAndTies) {
  std::mt19937 random(2006);
  AliasFreeMemory memory;
  Sum sum;
  for (int i = 0; i < kScenes; ++i) {
    const Scene scene = open_scene(random);
    add(sum, scene, camera_anywhere(random), memory);
  }
  report("open meshes", sum);
  EXPECT_EQ(sum.rays.unexplained, 0u);
  EXPECT_LT(sum.rays.wrong, sum.rays.tested / 1000);
  EXPECT_GT(sum.shadowed, sum.rays.tested / 20);
}

// All around: bodies and points on all six faces of the light's view; in every second scene the
// light is inside a body, which keeps it in.
TEST(AliasFreeMap, OfALightInsideTheSceneDiffersFromTheRaysOnlyAtEdgesAndTies) {
  std::mt19937 random(2007);
  AliasFreeMemory memory;
  Sum sum;
  for (int i = 0; i < kScenes; ++i) {
    Scene scene = test::random_scene(random);
    Object room = scene.objects[0];
    room.name = "room";
    room.model = test::model_of(test::box_mesh({5.0f, 4.0f, 5.0f}));
    room.world_from_model = test::placed({0.0f, 1.5f, 0.0f});
    scene.objects.push_back(room);
    glm::vec3 at = test::uniform_point(random, -1.5f, 1.5f);
    at.y = test::uniform(random, 0.3f, 2.0f);
    if (i % 2 == 1) at = glm::vec3(scene.objects[1].world_from_model[3]);
    scene.lights[0].position = glm::vec4(at, 1.0f);
    add(sum, scene, camera_anywhere(random), memory);
  }
  report("light inside", sum);
  EXPECT_EQ(sum.rays.unexplained, 0u);
  EXPECT_LT(sum.rays.wrong, sum.rays.tested / 500);
  EXPECT_GT(sum.shadowed, sum.rays.tested / 20);
}

TEST(AliasFreeMap, OfGrazingLightDiffersFromTheRaysOnlyAtEdgesAndTies) {
  std::mt19937 random(2008);
  AliasFreeMemory memory;
  Sum sum;
  for (int i = 0; i < kScenes; ++i) {
    Scene scene = test::random_scene(random);
    const float height = test::uniform(random, 0.002f, 0.05f), angle = test::uniform(random, 0, 6);
    const glm::vec3 towards(std::cos(angle), height, std::sin(angle));
    scene.lights[0].position = i % 2 ? glm::vec4(towards, 0.0f) : glm::vec4(towards * 3.5f, 1.0f);
    add(sum, scene, camera_anywhere(random), memory);
  }
  report("grazing light", sum);
  EXPECT_EQ(sum.rays.unexplained, 0u);
  EXPECT_LT(sum.rays.wrong, sum.rays.tested / 500);
  EXPECT_GT(sum.shadowed, sum.rays.tested / 20);
}

/// A sheet of 20 x 20 squares, turned and moved: its triangles lie in one plane up to rounding.
Object turned_sheet(std::mt19937& random) {
  Mesh mesh;
  constexpr std::uint32_t kSide = 21;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    mesh.positions.emplace_back(static_cast<float>(i % kSide) * 0.15f - 1.5f, 0.0f,
                                static_cast<float>(i / kSide) * 0.15f - 1.5f, 1.0f);
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = y * kSide + x;
      mesh.indices.insert(mesh.indices.end(),
                          {a, a + kSide, a + kSide + 1, a, a + kSide + 1, a + 1});
    }
  }
  const glm::vec3 axis = glm::normalize(test::uniform_point(random, -1.0f, 1.0f));
  return {.name = "sheet",
          .model = test::model_of(mesh),
          .world_from_model = test::placed(test::uniform_point(random, -100.0f, 100.0f), axis,
                                           test::uniform(random, 0.0f, 6.0f))};
}

// Oracle: a plane shadows no point of itself, from whichever side and at whatever angle the light
// falls; seen from the light's side all of it is lit, from the other side all of it is dark.
TEST(AliasFreeMap, NoFlatSheetShadowsItself) {
  std::mt19937 random(2009);
  AliasFreeMemory memory;
  std::size_t lit = 0, dark = 0;
  for (int i = 0; i < 60; ++i) {
    Scene scene;
    scene.objects.push_back(turned_sheet(random));
    const glm::mat4& world = scene.objects[0].world_from_model;
    const float angle = test::uniform(random, 0.0f, 6.0f);
    const glm::vec4 light(std::cos(angle) * 9.0f, std::pow(0.1f, static_cast<float>(i % 5)),
                          std::sin(angle) * 9.0f, 1.0f);
    scene.lights.push_back({.name = "lamp", .position = world * light});
    if (i % 2) scene.lights[0].position = world * glm::vec4(glm::vec3(light), 0.0f);
    const bool same_side = i % 3 != 0;
    const glm::vec3 eye(world * glm::vec4(0.7f, same_side ? 2.0f : -2.0f, 1.1f, 1.0f));
    const Camera camera = test::look(eye, glm::vec3(world[3]), 200, 150);
    const test::Counted drawn = draw_hidden(scene, camera, memory);
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        if (drawn.depth.at(x, y) == drawn.depth.max_value()) continue;
        ++(same_side ? lit : dark);
        ASSERT_EQ(drawn.stencil.at(x, y), same_side ? 0 : 1) << "scene " << i;
      }
    }
  }
  EXPECT_GT(lit, 100000u);
  EXPECT_GT(dark, 100000u);
}

// Oracle: the volumes' stencil. A parallel camera has no eye that rays could come from.
TEST(AliasFreeMap, ServesAParallelProjection) {
  std::mt19937 random(2010);
  AliasFreeMemory memory;
  std::size_t tested = 0, different = 0, shadowed = 0;
  for (int i = 0; i < 20; ++i) {
    const Scene scene = test::random_scene(random);
    Camera camera = camera_anywhere(random);
    camera.clip_from_world =
        glm::ortho(-2.0f, 2.0f, -1.5f, 1.5f, -20.0f, 20.0f) *
        glm::lookAt(camera.eye_world, glm::vec3(0.0f), glm::vec3(0.0f, 1.0f, 0.0f));
    const test::Counted drawn = draw_hidden(scene, camera, memory);
    const test::Counted counted = test::count_scene(scene, camera, {.method = VolumeMethod::zfail});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (drawn.depth.at(x, y) == drawn.depth.max_value()) continue;
        ++tested;
        shadowed += drawn.stencil.at(x, y) != 0;
        different += (drawn.stencil.at(x, y) != 0) != (counted.stencil.at(x, y) != 0);
      }
    }
  }
  std::printf("parallel: %zu of %zu pixels differ from the volumes, %zu in shadow\n", different,
              tested, shadowed);
  EXPECT_GT(shadowed, tested / 20);
  EXPECT_LT(different, tested / 2000);
}

TEST(AliasFreeMap, IsTheSameForEveryNumberOfThreads) {
  std::mt19937 random(2011);
  for (int i = 0; i < 10; ++i) {
    const Scene scene = i % 2 ? open_scene(random) : test::random_scene(random);
    const Camera camera = camera_anywhere(random);
    AliasFreeMemory alone;
    const auto expected = draw_hidden(scene, camera, alone, 1).stencil.to_rows();
    const std::vector<std::uint8_t> mask = alone.hidden;
    for (const int threads : {2, 3, 7}) {
      AliasFreeMemory memory;
      EXPECT_EQ(draw_hidden(scene, camera, memory, threads).stencil.to_rows(), expected);
      EXPECT_EQ(memory.hidden, mask);
    }
  }
}

// The stencil's rectangles are the mask, pixel by pixel, at sizes that float32 does not divide.
TEST(AliasFreeMap, IsDrawnIntoExactlyItsPixels) {
  std::mt19937 random(2012);
  const std::array<std::array<int, 2>, 7> sizes{
      {{1, 1}, {7, 5}, {63, 65}, {333, 1}, {1, 1001}, {1919, 1079}, {16384, 3}}};
  for (const auto& [width, height] : sizes) {
    std::vector<std::uint8_t> hidden(static_cast<std::size_t>(width * height));
    for (std::uint8_t& pixel : hidden) pixel = static_cast<std::uint8_t>(random() % 3 == 0);
    raster::StencilBuffer stencil(width, height);
    raster::Frame frame;
    frame.begin_pass("mask", {.stencil = &stencil});
    stencil_hidden(frame, hidden, width, height, "mask");
    raster::execute(frame);
    EXPECT_EQ(stencil.to_rows(), hidden) << width << " x " << height;
  }
}

// Oracle: what cannot be drawn casts nothing, and nothing else changes.
TEST(AliasFreeMap, TakesMeshesThatAreHostile) {
  std::mt19937 random(2013);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float huge = std::numeric_limits<float>::max();
  for (int i = 0; i < 10; ++i) {
    Scene scene = test::random_scene(random);
    const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
    AliasFreeMemory memory;
    draw_hidden(scene, camera, memory);
    const std::vector<std::uint8_t> expected = memory.hidden;
    Mesh bad = test::square_mesh(0.5f);
    bad.positions.insert(bad.positions.end(), {{nan, 0, 0, 1},
                                               {INFINITY, 1, 0, 1},
                                               {0.1f, 0.1f, 0.1f, 1},
                                               {0.2f, 0.2f, 0.2f, 1},
                                               {0.3f, 0.3f, 0.3f, 1}});
    bad.normals.clear();
    bad.indices = {0, 1, 4, 5, 6, 7, 6, 7, 8, 6, 6, 7, 4, 4, 4};
    scene.objects.push_back({.name = "bad", .model = test::model_of(bad)});
    scene.objects.push_back({.name = "empty", .model = test::model_of(Mesh{})});
    draw_hidden(scene, camera, memory);
    EXPECT_EQ(memory.hidden, expected);
    // Far corners, whose bounds cover all points: no crash, and every pixel is 0 or 1.
    bad.positions[4] = {huge, -huge, huge, 1};
    bad.positions[5] = {-huge, -huge, 1e-30f, 1};
    scene.objects.back().model = test::model_of(bad);
    draw_hidden(scene, camera, memory);
    for (const std::uint8_t pixel : memory.hidden) ASSERT_LE(pixel, 1);
  }
}

// Closed forms: a light in a sheet's plane, at a corner of it, or on the plate casts no shadow of
// that sheet; an upright sheet shadows what is beyond it.
TEST(AliasFreeMap, TakesALightInATrianglesPlaneOrOnAPoint) {
  Scene scene;
  scene.objects.push_back(
      {.name = "plate", .model = test::model_of(test::square_mesh(3.0f)), .casts = false});
  scene.objects.push_back({.name = "sheet",
                           .model = test::model_of(test::square_mesh(0.5f)),
                           .world_from_model = test::placed({0.0f, 1.0f, 0.0f})});
  scene.lights.push_back({.name = "lamp"});
  const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
  AliasFreeMemory memory;
  const auto shadowed = [&](const glm::vec4& light) {
    scene.lights[0].position = light;
    std::size_t count = 0;
    for (const std::uint8_t v : draw_hidden(scene, camera, memory).stencil.to_rows()) count += v;
    return count;
  };
  // The sheet itself is dark where the light is in its plane: n.l is 0 there.
  const std::size_t sheet = shadowed({2.0f, 1.0f, 0.3f, 1.0f});
  EXPECT_GT(sheet, 500u);
  EXPECT_EQ(shadowed({0.5f, 1.0f, 0.5f, 1.0f}), sheet);
  EXPECT_EQ(shadowed({1.0f, 0.0f, 0.0f, 0.0f}), sheet);
  EXPECT_EQ(shadowed({0.0f, 0.0f, 0.0f, 1.0f}), sheet);
  EXPECT_GT(shadowed({0.0f, 3.0f, 0.0f, 1.0f}), 500u);
  EXPECT_GT(shadowed({0.0f, 1.0f, 0.0f, 0.0f}), 500u);
}

TEST(AliasFreeMap, LeavesObjectsAloneThatReceiveNothing) {
  std::mt19937 random(2014);
  Scene scene = test::random_scene(random);
  scene.objects[0].receives = false;
  const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
  AliasFreeMemory memory;
  const test::Counted drawn = draw_hidden(scene, camera, memory);
  std::size_t plate = 0, shadowed = 0;
  for (std::size_t i = 0; i < memory.hidden.size(); ++i) {
    const VisiblePoint& point = memory.finder.points()[i];
    shadowed += memory.hidden[i];
    if (point.object != 0) continue;
    ++plate;
    EXPECT_EQ(memory.hidden[i], 0);
  }
  EXPECT_GT(plate, 10000u);
  EXPECT_GT(shadowed, 100u);
}

// Oracle: the volumes' picture, from which it may differ at shadows' edges only, whether the other
// light has volumes or not.
TEST(AliasFreeMap, ServesTheGeneralMethodLightByLight) {
  std::mt19937 random(2015);
  Scene scene = test::random_scene(random);
  scene.lights[0].position = {1.0f, 5.0f, 0.5f, 1.0f};
  scene.lights.push_back({.name = "sun", .position = {0.3f, 1.0f, -0.2f, 0.0f}});
  const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
  AliasFreeMemory memory;
  const auto draw = [&](ShadowMethod first, ShadowMethod second) {
    scene.lights[0].shadow = first;
    scene.lights[1].shadow = second;
    raster::ColorBuffer color(kWidth, kHeight);
    raster::DepthBuffer depth(kWidth, kHeight);
    raster::StencilBuffer stencil(kWidth, kHeight);
    raster::execute(
        record_general(scene, camera, {&color, &depth, &stencil}, {.alias_free = &memory}));
    return color.to_rgba8_rows();
  };
  const auto differing = [](const auto& a, const auto& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); i += 4)
      count += !std::equal(a.begin() + static_cast<std::ptrdiff_t>(i),
                           a.begin() + static_cast<std::ptrdiff_t>(i + 4),
                           b.begin() + static_cast<std::ptrdiff_t>(i));
    return count;
  };
  const auto expected = draw(ShadowMethod::volumes, ShadowMethod::volumes);
  EXPECT_GT(differing(expected, draw(ShadowMethod::none, ShadowMethod::none)), 3000u);
  for (const auto second : {ShadowMethod::alias_free, ShadowMethod::volumes})
    EXPECT_LT(differing(draw(ShadowMethod::alias_free, second), expected), 100u);
}

}  // namespace
}  // namespace gnomon::pipeline
