#include "pipeline/shadow_map.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <stdexcept>

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

  bool shows_surface(int x, int y) const { return depth.at(x, y) != depth.max_value(); }
};

void draw(Picture& picture, const Scene& scene, const Camera& camera) {
  MapMemory maps;
  raster::execute(record_general(scene, camera, {&picture.color, &picture.depth, &picture.stencil},
                                 {.maps = &maps}));
}

Scene with(Scene scene, ShadowMethod method, const MapSettings& settings = {}) {
  for (Light& light : scene.lights) {
    light.shadow = method;
    light.map = settings;
  }
  return scene;
}

/// One sheet that casts and receives, under a light that is not edge-on to it.
Scene sheet_scene(std::mt19937& random, bool is_point) {
  Scene scene;
  scene.objects.push_back({.name = "sheet",
                           .model = test::model_of(test::square_mesh(2.0f)),
                           .world_from_model = test::placed(
                               glm::vec3(0.0f), glm::normalize(test::uniform_point(random, -1, 1)),
                               test::uniform(random, 0.0f, 0.8f))});
  const glm::vec3 towards(test::uniform(random, -3.0f, 3.0f), test::uniform(random, 1.0f, 3.0f),
                          test::uniform(random, -3.0f, 3.0f));
  scene.lights.push_back({.name = "lamp", .position = glm::vec4(towards, 1.0f)});
  if (!is_point) scene.lights[0].position = glm::vec4(glm::normalize(towards), 0.0f);
  return scene;
}

// Oracle: a flat sheet shadows no point of itself, so the picture is the one without shadows. The
// offset that is found must keep it so at every size, filter and format.
TEST(ShadowMap, AFlatSheetDoesNotShadowItself) {
  std::mt19937 random(1978);
  int maps = 0;
  for (int i = 0; i < 60; ++i) {
    const Scene scene = sheet_scene(random, i % 2 == 0);
    const Camera camera = test::look({1.0f, 3.0f, 3.0f}, glm::vec3(0.0f), kWidth, kHeight);
    Picture expected;
    draw(expected, with(scene, ShadowMethod::none), camera);
    for (const auto filter : {raster::Filter::nearest, raster::Filter::linear}) {
      for (const auto format : {raster::DepthFormat::d16, raster::DepthFormat::d24}) {
        MapSettings settings{.filter = filter, .format = format};
        if (i % 3 > 0) settings.size = i % 3 == 1 ? 37 : 512;
        const auto plan = plan_shadow_map(scene, Casters(scene), scene.lights[0], camera, settings);
        // Some sheets are too oblique for a point light's one map; they get volumes.
        if (!plan) continue;
        ++maps;
        ASSERT_FALSE(plan->empty) << "scene " << i;
        // A thousandth of the depths, far from taking a shadow away.
        const double one = format == raster::DepthFormat::d24 ? 0xffffff : 0xffff;
        ASSERT_LT(plan->offset.units, one / 1000.0) << "scene " << i;
        Picture picture;
        draw(picture, with(scene, ShadowMethod::map, settings), camera);
        std::size_t wrong = 0;
        for (int y = 0; y < kHeight; ++y)
          for (int x = 0; x < kWidth; ++x)
            wrong += picture.color.at(x, y) != expected.color.at(x, y);
        EXPECT_EQ(wrong, 0u) << "scene " << i << ", size " << settings.size.value_or(0);
      }
    }
  }
  EXPECT_GT(maps, 150);
}

/// Pixels of the picture that differ from the lit one.
std::size_t dark_pixels(const Scene& scene, const Camera& camera, ShadowMethod method) {
  Picture lit, picture;
  draw(lit, with(scene, ShadowMethod::none), camera);
  draw(picture, with(scene, method), camera);
  std::size_t dark = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) dark += picture.color.at(x, y) != lit.color.at(x, y);
  return dark;
}

// A sheet across a light at infinity has one depth only. Oracle: the volumes' number of dark
// pixels, up to a tenth, which its outline has.
TEST(ShadowMap, ASheetAcrossTheLightShadowsWhatLiesBelow) {
  for (const float w : {0.0f, 1.0f}) {
    Scene scene;
    scene.objects.push_back(
        {.name = "plate", .model = test::model_of(test::square_mesh(3.0f)), .casts = false});
    scene.objects.push_back({.name = "sheet",
                             .model = test::model_of(test::square_mesh(0.6f)),
                             .world_from_model = test::placed({0.0f, 1.0f, 0.0f})});
    scene.lights.push_back({.name = "lamp", .position = {0.0f, w == 0.0f ? 1.0f : 4.0f, 0.0f, w}});
    const Camera camera = test::look({1.5f, 2.5f, 3.5f}, {0.0f, 0.3f, 0.0f}, kWidth, kHeight);
    const auto dark = static_cast<double>(dark_pixels(scene, camera, ShadowMethod::map));
    const auto expected = static_cast<double>(dark_pixels(scene, camera, ShadowMethod::volumes));
    EXPECT_GT(expected, 300.0);
    EXPECT_NEAR(dark, expected, 0.1 * expected) << "w " << w;
  }
}

// A plate a tenth of a millimetre thick is closed, and its averted face as good as in its lit one.
// Oracle: no shadow falls on it. Without the factor there is acne, so the test can fail.
TEST(ShadowMap, AThinClosedPlateDoesNotShadowItself) {
  Scene scene;
  scene.objects.push_back(
      {.name = "plate",
       .model = test::model_of(test::box_mesh({1.0f, 0.00005f, 1.0f})),
       .world_from_model = test::placed({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, 0.3f)});
  scene.lights.push_back({.name = "lamp", .position = {3.0f, 1.5f, 0.5f, 1.0f}});
  const Camera camera = test::look({1.0f, 2.0f, 2.0f}, glm::vec3(0.0f), kWidth, kHeight);
  Picture lit, found, without;
  draw(lit, with(scene, ShadowMethod::none), camera);
  draw(found, with(scene, ShadowMethod::map, {.size = 256}), camera);
  draw(without,
       with(scene, ShadowMethod::map, {.size = 256, .offset = raster::PolygonOffset{0.0f, 2.0f}}),
       camera);
  std::size_t wrong = 0, acne = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      wrong += found.color.at(x, y) != lit.color.at(x, y);
      acne += without.color.at(x, y) != lit.color.at(x, y);
    }
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(acne, 500u);
}

// A closed body whose triangles run the wrong way round shows the light's map the very side that is
// lit. Oracle: the same body turned right, but for pixels at edges; without an offset there is
// acne.
TEST(ShadowMap, ABodyTurnedInsideOutDoesNotShadowItself) {
  Mesh ball = test::icosphere_mesh(0.8f, 4);
  for (std::size_t i = 0; i < ball.indices.size(); i += 3)
    std::swap(ball.indices[i + 1], ball.indices[i + 2]);
  Scene scene;
  scene.objects.push_back({.name = "ball", .model = test::model_of(std::move(ball))});
  scene.lights.push_back({.name = "lamp", .position = {3.0f, 2.5f, 2.0f, 1.0f}});
  const Camera camera = test::look({2.0f, 1.5f, 2.0f}, glm::vec3(0.0f), kWidth, kHeight);
  Picture lit, found, without;
  draw(lit, with(scene, ShadowMethod::none), camera);
  draw(found, with(scene, ShadowMethod::map, {.size = 256}), camera);
  draw(without,
       with(scene, ShadowMethod::map, {.size = 256, .offset = raster::PolygonOffset{0.0f, 2.0f}}),
       camera);
  std::size_t shown = 0, wrong = 0, acne = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      shown += lit.depth.at(x, y) != lit.depth.max_value();
      wrong += found.color.at(x, y) != lit.color.at(x, y);
      acne += without.color.at(x, y) != lit.color.at(x, y);
    }
  }
  // Where light grazes the ball a texel is longer than its offset.
  EXPECT_LT(wrong, shown / 100);
  EXPECT_GT(acne, shown / 10);
}

// A closed room that is lit from within shows the very faces that its map holds, all of them turned
// from the lamp by their winding: they need the slope's factor. Oracle: nothing is in it that
// casts, so nothing is dark.
TEST(ShadowMap, AClosedRoomDoesNotShadowItsOwnWalls) {
  Scene scene;
  auto model = std::make_shared<Model>(*test::model_of(test::flat_box_mesh(glm::vec3(2.0f))));
  for (Part& part : model->parts) part.two_sided = true;
  scene.objects.push_back({.name = "room", .model = model});
  scene.lights.push_back({.name = "lamp", .position = {0.7f, 0.6f, -0.3f, 1.0f}});
  const Camera camera = test::look({-1.5f, 1.2f, 1.5f}, glm::vec3(0.0f), kWidth, kHeight, 80.0f);
  Picture dark, lit, found;
  Scene unlit = scene;
  unlit.lights[0].color = glm::vec3(0.0f);
  draw(dark, with(unlit, ShadowMethod::none), camera);
  draw(lit, with(scene, ShadowMethod::none), camera);
  draw(found, with(scene, ShadowMethod::map, {.size = 200}), camera);
  std::size_t wrong = 0, reached = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      reached += lit.color.at(x, y) != dark.color.at(x, y);
      wrong += found.color.at(x, y) != lit.color.at(x, y);
    }
  }
  EXPECT_GT(reached, 20000u);
  EXPECT_EQ(wrong, 0u);
}

// AFlatSheetDoesNotShadowItself can fail: without the offset there is acne.
TEST(ShadowMap, WithoutAnOffsetASheetShadowsItself) {
  std::mt19937 random(1978);
  const Scene scene = sheet_scene(random, true);
  const Camera camera = test::look({1.0f, 3.0f, 3.0f}, glm::vec3(0.0f), kWidth, kHeight);
  Picture lit, picture;
  draw(lit, with(scene, ShadowMethod::none), camera);
  draw(picture, with(scene, ShadowMethod::map, {.offset = raster::PolygonOffset{}}), camera);
  std::size_t wrong = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) wrong += picture.color.at(x, y) != lit.color.at(x, y);
  EXPECT_GT(wrong, 500u);
}

struct Count {
  std::size_t tested = 0, wrong = 0, shadowed = 0;
};

/// Pixels whose light, on or off, is not the rays' answer, of those that face the light.
Count compare(const Picture& picture, const Picture& lit, const Scene& scene,
              const RayReference& rays, const Camera& camera) {
  Count count;
  const auto samples = rays.cast(pixel_rays(camera), scene.lights[0].position);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto& sample = samples[static_cast<std::size_t>(y) * kWidth + x];
      if (!sample.hit.hit || sample.shadow.faces_away || !picture.shows_surface(x, y)) continue;
      ++count.tested;
      const bool in_shadow = picture.color.at(x, y) != lit.color.at(x, y);
      count.shadowed += sample.shadow.blocked;
      count.wrong += in_shadow != sample.shadow.blocked;
    }
  }
  return count;
}

// Oracle: Embree. What is wrong with a map lies along shadows' edges, so it shrinks with the texel;
// the size that is found has texels of a pixel.
TEST(ShadowMap, ComesNearerToTheRaysWithItsSize) {
  std::mt19937 random(512);
  std::array<Count, 4> sums;
  for (int i = 0; i < 30; ++i) {
    Scene scene = test::random_scene(random);
    // A light that one map can serve.
    if (scene.lights[0].position.w != 0.0f) scene.lights[0].position.y += 6.0f;
    const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
    const RayReference rays(scene);
    Picture lit;
    draw(lit, with(scene, ShadowMethod::none), camera);
    for (std::size_t k = 0; k < 4; ++k) {
      MapSettings settings;
      if (k < 3) settings.size = 64 << (2 * k);
      Picture picture;
      draw(picture, with(scene, ShadowMethod::map, settings), camera);
      const Count count = compare(picture, lit, scene, rays, camera);
      sums[k].tested += count.tested;
      sums[k].wrong += count.wrong;
      sums[k].shadowed += count.shadowed;
    }
  }
  std::printf("wrong of %zu pixels (%zu in shadow): size 64 %zu, 256 %zu, 1024 %zu, found %zu\n",
              sums[0].tested, sums[0].shadowed, sums[0].wrong, sums[1].wrong, sums[2].wrong,
              sums[3].wrong);
  EXPECT_GT(sums[0].shadowed, 20000u);
  EXPECT_LT(sums[1].wrong * 2, sums[0].wrong);
  EXPECT_LT(sums[2].wrong * 2, sums[1].wrong);
  // One pixel in a hundred: a texel is a pixel, so what is wrong is on outlines, of which these
  // pictures have a few hundred pixels in 30,000.
  EXPECT_LT(sums[3].wrong * 100, sums[3].tested);
}

Scene box_above_plate() {
  Scene scene;
  scene.objects.push_back(
      {.name = "plate", .model = test::model_of(test::square_mesh(3.0f)), .casts = false});
  scene.objects.push_back({.name = "box",
                           .model = test::model_of(test::box_mesh(glm::vec3(0.3f))),
                           .world_from_model = test::placed({0.0f, 0.6f, 0.0f})});
  scene.lights.push_back({.name = "lamp", .position = {0.5f, 4.0f, 0.3f, 1.0f}});
  return scene;
}

// Closed form: from straight above at 4 m, a box's top 0.6 m wide at 0.9 m spans 0.6 / 3.1 of
// slope.
TEST(ShadowMap, IsFittedToTheCasters) {
  Scene scene = box_above_plate();
  scene.lights[0].position = {0.0f, 4.0f, 0.0f, 1.0f};
  const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
  const auto plan = plan_shadow_map(scene, Casters(scene), scene.lights[0], camera, {.size = 1000});
  ASSERT_TRUE(plan && !plan->empty);
  const double half = 0.3 / 3.1 * (1.0 + 4.0 / 1000.0);
  for (const float side : {-1.0f, 1.0f}) {
    // The edges of the view go through the corners of the margin.
    const auto z = static_cast<float>(half * 3.1);
    const glm::vec4 clip = plan->clip_from_world * glm::vec4(side * z, 0.9f, side * z, 1.0f);
    EXPECT_NEAR(std::abs(clip.x / clip.w), 1.0f, 1e-5f);
    EXPECT_NEAR(std::abs(clip.y / clip.w), 1.0f, 1e-5f);
  }
}

TEST(ShadowMap, IsNotNeededWhereNoVisibleReceiverIsBehindACaster) {
  const Scene scene = box_above_plate();
  const Camera away = test::look({2.0f, 0.3f, 0.0f}, {3.0f, 0.0f, 0.0f}, kWidth, kHeight);
  const auto plan = plan_shadow_map(scene, Casters(scene), scene.lights[0], away, {});
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->empty);
}

// A light among its casters for which one map is asked is served by volumes: the bytes are theirs.
TEST(ShadowMap, LeavesALightThatItCannotServeToVolumes) {
  Scene scene = box_above_plate();
  scene.lights[0].position = {0.9f, 0.6f, 0.0f, 1.0f};
  const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
  EXPECT_FALSE(plan_shadow_map(scene, Casters(scene), scene.lights[0], camera, {}));
  Picture by_map, by_volumes;
  draw(by_map, with(scene, ShadowMethod::map, {.sides = MapSides::one}), camera);
  draw(by_volumes, with(scene, ShadowMethod::volumes), camera);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      ASSERT_EQ(by_map.color.at(x, y), by_volumes.color.at(x, y)) << x << ", " << y;
}

// Kuehl, section 5: both methods on different lights of one scene. Oracle: light is additive, so
// the picture less the ambient light is the sum of the lights' own pictures, and nothing is darker
// than the ambient light where both shadows fall.
TEST(ShadowMap, AndVolumesOnTwoLightsDarkenNothingTwice) {
  Scene scene = box_above_plate();
  scene.lights.push_back({.name = "sun",
                          .position = glm::vec4(glm::normalize(glm::vec3(0.1f, 1.0f, -0.1f)), 0.0f),
                          .color = glm::vec3(0.4f)});
  scene.lights[0].color = glm::vec3(0.5f);
  scene.lights[0].shadow = ShadowMethod::map;
  const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
  Scene dark = scene, first = scene, second = scene;
  dark.lights.clear();
  first.lights.pop_back();
  const auto plan = plan_shadow_map(scene, Casters(scene), scene.lights[0], camera, {});
  ASSERT_TRUE(plan && !plan->empty);
  second.lights.erase(second.lights.begin());
  Scene plate = scene;
  plate.objects.pop_back();
  Picture both, ambient, lamp, sun, plate_only;
  draw(plate_only, plate, camera);
  draw(both, scene, camera);
  draw(ambient, dark, camera);
  draw(lamp, first, camera);
  draw(sun, second, camera);
  std::size_t in_both_shadows = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (!both.shows_surface(x, y)) continue;
      const glm::vec4 base = ambient.color.at(x, y);
      const glm::vec4 sum = lamp.color.at(x, y) + sun.color.at(x, y) - base;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(both.color.at(x, y)[c], sum[c], 1e-6f);
      // Of the plate, which faces both lights: it is the only thing below the box's bottom.
      const bool on_plate = both.depth.at(x, y) == plate_only.depth.at(x, y);
      in_both_shadows += on_plate && both.color.at(x, y) == base;
    }
  }
  EXPECT_GT(in_both_shadows, 100u);
}

TEST(ShadowMap, SettingsAreChecked) {
  const Scene scene = box_above_plate();
  const Camera camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
  const auto plan = [&](const MapSettings& settings) {
    return plan_shadow_map(scene, Casters(scene), scene.lights[0], camera, settings);
  };
  EXPECT_THROW(plan({.size = 0}), std::invalid_argument);
  EXPECT_THROW(plan({.size = 20000}), std::invalid_argument);
  EXPECT_THROW(plan({.fov_tangent = 0.0f}), std::invalid_argument);
  EXPECT_THROW(plan({.near_far_m = glm::vec2(0.1f, INFINITY)}), std::invalid_argument);
  EXPECT_THROW(plan({.near_far_m = glm::vec2(2.0f, 1.0f)}), std::invalid_argument);
  EXPECT_THROW(plan({.near_far_m = glm::vec2(0.0f, 1.0f)}), std::invalid_argument);
  EXPECT_TRUE(plan({.size = 16384, .fov_tangent = 1.0f, .near_far_m = glm::vec2(0.1f, 9.0f)}));
}

}  // namespace
}  // namespace gnomon::pipeline
