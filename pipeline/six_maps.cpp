#include "pipeline/six_maps.h"

#include <memory>
#include <string>
#include <utility>

#include "pipeline/light_view.h"
#include "pipeline/placed_object.h"

namespace gnomon::pipeline {
namespace {

LightView view_of_side(const Light& light, int side) {
  glm::dvec3 axis(0.0);
  axis[side / 2] = side % 2 == 0 ? 1.0 : -1.0;
  return LightView::about(light, axis);
}

constexpr Rectangle whole_side() { return {glm::dvec2(-1.0), glm::dvec2(1.0)}; }

/// From the light to infinity: its sides, and its end at infinity.
struct Pyramid {
  std::array<glm::vec4, 5> positions;
  std::array<std::uint32_t, 18> indices{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 1, 2, 3, 1, 3, 4};
};

}  // namespace

const char* cube_side_name(int side) {
  constexpr std::array<const char*, kCubeSides> kNames{"+x", "-x", "+y", "-y", "+z", "-z"};
  return kNames[static_cast<std::size_t>(side)];
}

std::array<MapPlan, kCubeSides> plan_six_maps(const Scene& scene, const Casters& casters,
                                              const Light& light, const Camera& camera,
                                              const MapSettings& settings) {
  MapSettings of_sides = settings;
  of_sides.sides = MapSides::six;
  const MapPlanner planner(scene, casters, light, camera, of_sides);
  std::array<MapPlan, kCubeSides> plans;
  for (int side = 0; side < kCubeSides; ++side)
    plans[static_cast<std::size_t>(side)] = *planner.plan(view_of_side(light, side), whole_side());
  return plans;
}

void mark_side(raster::Frame& frame, const Light& light, const Camera& camera, int side) {
  frame.clear({.stencil = 0, .stencil_write_mask = kSideBit});
  auto pyramid = std::make_shared<Pyramid>();
  pyramid->positions[0] = light.position;
  const std::array<glm::dvec3, 4> corners = view_of_side(light, side).corners(whole_side());
  for (std::size_t i = 0; i < corners.size(); ++i)
    pyramid->positions[i + 1] = glm::vec4(glm::vec3(corners[i]), 0.0f);
  // As volumes are counted on depth fail; whether a number is odd does not depend on which way a
  // triangle faces.
  raster::Draw draw;
  draw.state = surface_state();
  draw.state.depth = raster::DepthState{.func = raster::CompareFunc::less, .write = false};
  draw.state.color = raster::ColorState::off();
  draw.state.stencil =
      raster::StencilState::both({.write_mask = kSideBit, .depth_fail = raster::StencilOp::invert});
  draw.mesh = {.positions = pyramid->positions, .indices = pyramid->indices};
  draw.clip_from_model = camera.clip_from_world;
  draw.label = "side " + std::string(cube_side_name(side)) + " of " + light.name;
  frame.keep(std::shared_ptr<const Pyramid>(std::move(pyramid)));
  frame.draw(std::move(draw));
}

}  // namespace gnomon::pipeline
