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

}  // namespace
}  // namespace gnomon::pipeline
