#include "pipeline/general_method.h"

#include <array>
#include <cstdio>

#include <gtest/gtest.h>
#include <glm/common.hpp>

#include "pipeline/ray_reference.h"
#include "raster/execute.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kWidth = 240, kHeight = 180;

struct Picture {
  raster::ColorBuffer color{kWidth, kHeight, raster::ColorFormat::rgba32f};
  raster::DepthBuffer depth{kWidth, kHeight};
  raster::StencilBuffer stencil{kWidth, kHeight};
};

void draw(Picture& picture, const Scene& scene, const Camera& camera) {
  raster::execute(
      record_general(scene, camera, {&picture.color, &picture.depth, &picture.stencil}));
}

TEST(GeneralMethod, PassesAreAmbientThenCountsAndLightForEachLight) {
  std::mt19937 random(70);
  Scene scene = test::random_scene(random);
  scene.lights.push_back(scene.lights[0]);
  scene.lights[1].name = "second";
  Picture picture;
  const raster::Frame frame =
      record_general(scene, test::look({3, 4, 5}, {0, 0, 0}, kWidth, kHeight),
                     {&picture.color, &picture.depth, &picture.stencil});
  ASSERT_EQ(frame.passes().size(), 5u);
  EXPECT_EQ(frame.passes()[0].label, "ambient pass");
  EXPECT_EQ(frame.passes()[1].label, "shadow volumes: lamp");
  EXPECT_EQ(frame.passes()[4].label, "lit pass: second");
}

/// Which of two lights the full picture holds at a pixel; fails when it is no sum of them.
std::array<bool, 2> lights_added(const Picture& full, const Picture& ambient,
                                 const std::array<Picture, 2>& lit, int x, int y) {
  const glm::vec4 base = ambient.color.at(x, y);
  for (const bool first : {true, false}) {
    for (const bool second : {true, false}) {
      glm::vec4 sum = base;
      if (first) sum += lit[0].color.at(x, y) - base;
      if (second) sum += lit[1].color.at(x, y) - base;
      const glm::vec4 off = glm::abs(full.color.at(x, y) - sum);
      if (off.r < 1e-5f && off.g < 1e-5f && off.b < 1e-5f) return {first, second};
    }
  }
  ADD_FAILURE() << "pixel " << x << ", " << y << " is no sum of the lights";
  return {};
}

// Oracle: light is additive, and Embree says which light reaches a point: the picture is the
// ambient one plus, for each light that does, what that light adds without any caster.
TEST(GeneralMethod, PictureIsTheSumOfTheLightsThatReachAPoint) {
  std::mt19937 random(71);
  std::size_t tested = 0, wrong = 0, unexplained = 0;
  for (int round = 0; round < 12; ++round) {
    Scene scene = test::random_scene(random);
    scene.lights.push_back({.name = "second", .position = {2, 5, -2, 1}, .color = {0, 0.5f, 1}});
    glm::vec3 eye = test::uniform_point(random, -6.0f, 6.0f);
    eye.y = test::uniform(random, 0.5f, 5.0f);
    const Camera camera = test::look(eye, {0, 0.5f, 0}, kWidth, kHeight);
    Picture full, ambient;
    std::array<Picture, 2> lit;
    draw(full, scene, camera);
    Scene bare = scene;
    for (Object& object : bare.objects) object.casts = false;
    bare.lights.clear();
    draw(ambient, bare, camera);
    for (std::size_t i = 0; i < 2; ++i) {
      bare.lights = {scene.lights[i]};
      draw(lit[i], bare, camera);
    }
    const RayReference rays(scene);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (full.depth.at(x, y) == full.depth.max_value()) continue;
        ++tested;
        const std::array<bool, 2> lights = lights_added(full, ambient, lit, x, y);
        const RayHit hit = rays.trace(window_ray(camera, x + 0.5, y + 0.5));
        for (std::size_t i = 0; i < 2; ++i) {
          const glm::vec4 light = scene.lights[i].position;
          const bool reaches = hit.hit && !rays.shadow(hit, light).in_shadow;
          const bool adds_nothing = lit[i].color.at(x, y) == ambient.color.at(x, y);
          if (adds_nothing || reaches == lights[i]) continue;
          ++wrong;
          unexplained += test::why(scene, rays, camera, light, x, y, full.depth.at(x, y),
                                   !lights[i]) == test::Reason::none;
        }
      }
    }
  }
  std::printf("general method: %zu pixels, %zu differ from the rays, %zu unexplained\n", tested,
              wrong, unexplained);
  EXPECT_EQ(unexplained, 0u);
  EXPECT_GT(tested, 100000u);
  EXPECT_LT(wrong, tested / 500);
}

/// So many boxes one above the other, a ground below, all in the light's way.
Scene tower(int boxes) {
  Scene scene;
  scene.objects.push_back(
      {.name = "ground", .model = test::model_of(test::square_mesh(3.0f)), .casts = false});
  const auto box = test::model_of(test::box_mesh({0.4f, 0.0005f, 0.4f}));
  for (int i = 0; i < boxes; ++i)
    scene.objects.push_back(
        {.name = "box",
         .model = box,
         .world_from_model = test::placed({0.0f, 0.5f + 0.0015f * static_cast<float>(i), 0.0f})});
  scene.lights.push_back({.name = "sun", .position = {0.0f, 1.0f, 0.0f, 0.0f}});
  return scene;
}

// Oracle: closed form. Under a tower of any height lies the shadow of one of its boxes; 8 bits that
// wrap would count 256 of them as none.
TEST(GeneralMethod, AnyNumberOfVolumesHidesTheLight) {
  const Camera camera = test::look({2.0f, 1.2f, 2.5f}, {0, 0.2f, 0}, kWidth, kHeight);
  const auto shadowed = [&](int boxes, VolumeMethod method) {
    const Scene scene = tower(boxes);
    Scene unlit = scene;
    for (Object& object : unlit.objects) object.casts = false;
    Picture with, without;
    raster::execute(record_general(scene, camera, {&with.color, &with.depth, &with.stencil},
                                   {.method = method}));
    draw(without, unlit, camera);
    std::size_t pixels = 0;
    // Of the ground alone, which the tower does not hide there.
    for (int y = 0; y < kHeight / 2; ++y)
      for (int x = 0; x < kWidth; ++x) pixels += with.color.at(x, y) != without.color.at(x, y);
    return pixels;
  };
  const std::size_t one = shadowed(1, VolumeMethod::zfail);
  EXPECT_GT(one, 500u);
  for (const VolumeMethod method :
       {VolumeMethod::zfail, VolumeMethod::zpass, VolumeMethod::automatic})
    for (const int boxes : {85, 86, 127, 128, 255, 256, 257, 512})
      EXPECT_EQ(shadowed(boxes, method), one) << boxes;
}

}  // namespace
}  // namespace gnomon::pipeline
