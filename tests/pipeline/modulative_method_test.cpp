#include "pipeline/modulative_method.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/general_method.h"
#include "pipeline/passes.h"
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
  raster::Targets targets() { return {&color, &depth, &stencil}; }
};

// Oracle: the counts themselves (held to the rays elsewhere): where they are not 0 and a surface
// is, the lit colour is halved, once; everywhere else it stays; and the stencil is used up.
TEST(ModulativeMethod, HalvesEachShadowedPixelOnce) {
  std::mt19937 random(2006);
  std::size_t darkened = 0;
  for (int i = 0; i < 20; ++i) {
    const Scene scene = test::random_scene(random);
    const Camera camera = test::look({3.0f, 4.0f, 5.0f}, glm::vec3(0.0f), kWidth, kHeight);
    Picture lit, picture;
    const raster::Frame lit_frame = record_modulative(scene, camera, lit.targets());
    raster::execute(lit_frame, {.commands = *commands_through(lit_frame, "lit scene")});
    raster::execute(record_modulative(scene, camera, picture.targets()));
    const test::Counted counted = test::count_scene(scene, camera, {});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool surface = lit.depth.at(x, y) != lit.depth.max_value();
        const bool shadow = surface && counted.stencil.at(x, y) != 0;
        const glm::vec4 full = lit.color.at(x, y), color = picture.color.at(x, y);
        for (int c = 0; c < 3; ++c)
          ASSERT_EQ(color[c], shadow ? full[c] * 0.5f : full[c])
              << "scene " << i << " " << x << " " << y;
        ASSERT_EQ(picture.stencil.at(x, y), 0) << "scene " << i << " " << x << " " << y;
        darkened += shadow;
      }
    }
  }
  EXPECT_GT(darkened, 10000u);
}

TEST(ModulativeMethod, DarkensOnceForEachLight) {
  std::mt19937 random(11);
  Scene scene = test::random_scene(random);
  scene.lights.push_back(scene.lights[0]);
  scene.lights[1].name = "second";
  const Camera camera = test::look({3.0f, 4.0f, 5.0f}, glm::vec3(0.0f), kWidth, kHeight);
  Picture lit, picture;
  const raster::Frame frame = record_modulative(scene, camera, picture.targets());
  ASSERT_EQ(frame.passes().size(), 5u);
  EXPECT_EQ(frame.passes()[4].label, "shadow quad: second");
  const raster::Frame lit_frame = record_modulative(scene, camera, lit.targets());
  raster::execute(lit_frame, {.commands = *commands_through(lit_frame, "lit scene")});
  raster::execute(frame);
  std::size_t quartered = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float full = lit.color.at(x, y).g, here = picture.color.at(x, y).g;
      // Both lights stand in one place, so what one does not reach the other does not.
      EXPECT_TRUE(here == full || here == full * 0.25f) << x << " " << y;
      quartered += full > 0.0f && here == full * 0.25f;
    }
  }
  EXPECT_GT(quartered, 500u);
}

// The error that the paper describes: a highlight in the shadow. A glossy ball wholly in a box's
// shadow keeps half its highlight; by the additive method (the oracle: no light arrives) it has
// none.
TEST(ModulativeMethod, LeavesHighlightsInTheShadow) {
  Scene scene;
  pipeline::Mesh ball = test::icosphere_mesh(0.4f, 4);
  auto glossy = std::make_shared<Model>(*test::model_of(ball));
  glossy->parts[0].material.specular = glm::vec3(1.0f);
  glossy->parts[0].material.shininess = 30;
  scene.objects.push_back({.name = "ball", .model = glossy});
  scene.objects.push_back({.name = "board",
                           .model = test::model_of(test::box_mesh({1.5f, 0.05f, 1.5f})),
                           .world_from_model = test::placed({0.0f, 3.0f, 0.0f})});
  scene.lights.push_back({.name = "lamp", .position = {0.0f, 6.0f, 0.5f, 1.0f}});
  const Camera camera = test::look({0.0f, 1.5f, 3.0f}, glm::vec3(0.0f), kWidth, kHeight);
  Picture modulative, additive;
  raster::execute(record_modulative(scene, camera, modulative.targets()));
  raster::execute(record_general(scene, camera, additive.targets()));
  float brightest = 0.0f, flattest = 1.0f, largest_additive = 0.0f;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (additive.depth.at(x, y) == additive.depth.max_value()) continue;
      // The lower half of the picture shows the ball alone.
      if (y > kHeight / 2 + 30) continue;
      brightest = std::max(brightest, modulative.color.at(x, y).g);
      flattest = std::min(flattest, modulative.color.at(x, y).g);
      largest_additive = std::max(largest_additive, additive.color.at(x, y).g);
    }
  }
  std::printf("ball in shadow: additive at most %.3f, modulative %.3f to %.3f\n",
              static_cast<double>(largest_additive), static_cast<double>(flattest),
              static_cast<double>(brightest));
  EXPECT_GT(brightest, 0.5f);
  EXPECT_LT(largest_additive, 0.3f);
  // And ambient light is lost, where the additive method keeps it.
  EXPECT_LT(flattest, largest_additive * 0.75f);
}

}  // namespace
}  // namespace gnomon::pipeline
