// What draw_lit records. Oracle: the fields of the draws.
#include "pipeline/placed_object.h"

#include <array>

#include <gtest/gtest.h>

#include "test_meshes.h"

namespace gnomon::pipeline {
namespace {

TEST(DrawLit, LightsAtVerticesWhereItIsAskedForAndNoMapScalesALight) {
  Scene scene{.objects = {{.name = "box", .model = test::model_of(test::box_mesh(glm::vec3(1)))}},
              .lights = {Light{}, Light{}}};
  raster::ColorBuffer color(8, 8);
  const raster::DepthBuffer map(8, 8);
  TopologyCache topologies;
  const Camera camera;
  const auto at_vertices = [&](std::span<const std::optional<raster::DepthLookup>> maps) {
    const auto objects = place_objects(scene, camera, topologies);
    raster::Frame frame;
    frame.begin_pass("lit", {.color = &color});
    draw_lit(frame, objects[0], scene, camera,
             {.diffuse = true, .lights = scene.lights, .shadow_maps = maps}, surface_state());
    const auto& draw = std::get<raster::Draw>(frame.passes()[0].commands.at(0));
    return std::get<raster::Lit>(draw.shading).at_vertices;
  };
  std::array<std::optional<raster::DepthLookup>, 2> maps;
  EXPECT_FALSE(at_vertices({}));
  scene.vertex_lighting = true;
  EXPECT_TRUE(at_vertices({}));
  EXPECT_TRUE(at_vertices(maps));
  maps[1] = raster::DepthLookup{.map = &map};
  EXPECT_FALSE(at_vertices(maps));
}

}  // namespace
}  // namespace gnomon::pipeline
