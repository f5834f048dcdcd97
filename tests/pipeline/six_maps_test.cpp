#include "pipeline/six_maps.h"

#include <array>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/general_method.h"
#include "pipeline/ray_reference.h"
#include "raster/execute.h"
#include "tests/pipeline/light_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kWidth = 200, kHeight = 150;

struct Picture : test::LightBuffers {
  Picture() : LightBuffers(kWidth, kHeight) {}
};

void draw(Picture& picture, Scene scene, const Camera& camera, ShadowMethod method,
          const MapSettings& settings = {}) {
  scene.lights[0].shadow = method;
  scene.lights[0].map = settings;
  MapMemory maps;
  raster::execute(record_general(scene, camera, {&picture.color, &picture.depth, &picture.stencil},
                                 {.maps = &maps}));
}

/// A lamp in a room of six walls, with bodies all around it.
Scene room(std::mt19937& random) {
  Scene scene;
  // A plate faces +y; turned so, all face the room.
  constexpr float kQuarter = 1.57079633f;
  constexpr std::array<float, kCubeSides> kTurns{kQuarter, -kQuarter, 2.0f * kQuarter,
                                                 0.0f,     -kQuarter, kQuarter};
  for (int side = 0; side < kCubeSides; ++side) {
    glm::vec3 at(0.0f);
    at[side / 2] = side % 2 == 0 ? 3.0f : -3.0f;
    const glm::vec3 axis =
        side / 2 == 0 ? glm::vec3(0.0f, 0.0f, 1.0f) : glm::vec3(1.0f, 0.0f, 0.0f);
    scene.objects.push_back(
        {.name = "wall",
         .model = test::model_of(test::square_mesh(3.0f)),
         .world_from_model = test::placed(at, axis, kTurns[static_cast<std::size_t>(side)]),
         .casts = false});
  }
  for (int i = 0; i < 9; ++i) {
    const glm::vec3 way = glm::normalize(test::uniform_point(random, -1.0f, 1.0f));
    scene.objects.push_back({.name = "body",
                             .model = test::model_of(i % 2 == 0 ? test::box_mesh(glm::vec3(0.25f))
                                                                : test::icosphere_mesh(0.3f, 2)),
                             .world_from_model = test::placed(
                                 way * test::uniform(random, 1.2f, 2.2f),
                                 glm::normalize(test::uniform_point(random, -1.0f, 1.0f)), 1.0f)});
  }
  scene.lights.push_back({.name = "lamp", .position = {0.1f, 0.2f, -0.1f, 1.0f}});
  return scene;
}

/// Between the bodies and the walls: a map of closed bodies does not know what is in them.
Camera in_room(std::mt19937& random) {
  return test::look(2.8f * glm::normalize(test::uniform_point(random, -1.0f, 1.0f)),
                    test::uniform_point(random, -1.0f, 1.0f), kWidth, kHeight, 90.0f);
}

// Oracle: without casters nothing is dark, so the picture drawn side by side is the one drawn at
// once. No pixel is left out between two sides and none is lit twice: zero tolerance.
TEST(SixMaps, SidesPartThePicture) {
  std::mt19937 random(6);
  for (int i = 0; i < 40; ++i) {
    Scene scene = room(random);
    // Six casters that hide nothing, far outside: every side has a map.
    for (Object& object : scene.objects) object.casts = false;
    for (int side = 0; side < kCubeSides; ++side) {
      glm::vec3 at(1.0f);
      at[side / 2] = side % 2 == 0 ? 50.0f : -50.0f;
      scene.objects.push_back({.name = "far",
                               .model = test::model_of(test::box_mesh(glm::vec3(0.1f))),
                               .world_from_model = test::placed(at)});
    }
    scene.lights[0].position = glm::vec4(test::uniform_point(random, -1.0f, 1.0f), 1.0f);
    const Camera camera = in_room(random);
    Picture at_once, by_sides;
    draw(at_once, scene, camera, ShadowMethod::none);
    draw(by_sides, scene, camera, ShadowMethod::map, {.sides = MapSides::six});
    std::size_t different = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        different += at_once.color.at(x, y) != by_sides.color.at(x, y);
    EXPECT_EQ(different, 0u) << "scene " << i;
  }
}

// Oracle: rays, for pixels that the lamp would light. A map of finite size is wrong along
// shadows' edges: by its texels' share of the picture, which is bounded here by one in a hundred.
TEST(SixMaps, ShadowEveryWayFromTheLamp) {
  std::mt19937 random(66);
  std::size_t tested = 0, wrong = 0, dark = 0;
  for (int i = 0; i < 12; ++i) {
    const Scene scene = room(random);
    const Camera camera = in_room(random);
    ASSERT_FALSE(plan_shadow_map(scene, Casters(scene), scene.lights[0], camera, {}));
    Scene unlit = scene;
    unlit.lights[0].color = glm::vec3(0.0f);
    Picture lit, picture, ambient;
    draw(ambient, unlit, camera, ShadowMethod::none);
    draw(lit, scene, camera, ShadowMethod::none);
    draw(picture, scene, camera, ShadowMethod::map);
    const auto samples = RayReference(scene).cast(pixel_rays(camera), scene.lights[0].position);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto& sample = samples[static_cast<std::size_t>(y * kWidth + x)];
        // The inside of a body, which a camera may see here, is black whatever the lamp does.
        if (lit.color.at(x, y) == ambient.color.at(x, y)) continue;
        const bool is_dark = picture.color.at(x, y) != lit.color.at(x, y);
        ++tested;
        dark += is_dark;
        wrong += is_dark != sample.shadow.in_shadow;
      }
    }
  }
  std::printf("six maps: %zu pixels, %zu dark, %zu wrong\n", tested, dark, wrong);
  EXPECT_GT(dark, tested / 20);
  EXPECT_LT(wrong, tested / 100);
}

// The angle of view is one map's: six maps show all of their sides whatever it is.
TEST(SixMaps, KnowNoAngleOfView) {
  std::mt19937 random(6666);
  const Scene scene = room(random);
  const Camera camera = in_room(random);
  Picture expected, narrow;
  draw(expected, scene, camera, ShadowMethod::map);
  draw(narrow, scene, camera, ShadowMethod::map, {.fov_tangent = 0.2f});
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      ASSERT_EQ(narrow.color.at(x, y), expected.color.at(x, y)) << x << ", " << y;
}

// The stencil that volumes leave goes on to count when sides are added: one caster has a volume,
// the others are in the maps. Oracle: all in maps, up to what edges differ.
TEST(SixMaps, ShareALightWithVolumes) {
  std::mt19937 random(666);
  for (int i = 0; i < 4; ++i) {
    Scene scene = room(random);
    const Camera camera = in_room(random);
    Picture maps, both, lit;
    draw(lit, scene, camera, ShadowMethod::none);
    draw(maps, scene, camera, ShadowMethod::map);
    for (std::size_t object = 0; object < scene.objects.size(); ++object)
      scene.lights[0].shadow_of_object.push_back(object % 2 == 0 ? ShadowMethod::volumes
                                                                 : ShadowMethod::map);
    draw(both, scene, camera, ShadowMethod::map);
    std::size_t dark = 0, different = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        dark += maps.color.at(x, y) != lit.color.at(x, y);
        different += maps.color.at(x, y) != both.color.at(x, y);
      }
    }
    EXPECT_GT(dark, 500u);
    EXPECT_LT(different, dark / 8) << "scene " << i;
  }
}

}  // namespace
}  // namespace gnomon::pipeline
