#include "tests/tools/mesh_above_plate.h"

#include <algorithm>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ar/stopwatch.h"
#include "pipeline/count_volumes.h"
#include "raster/execute.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::test {

using namespace pipeline;

namespace {

struct Bounds {
  glm::vec3 low{1e30f}, high{-1e30f};
};

Bounds bounds_of(const Model& model, const glm::mat4& world_from_model) {
  Bounds bounds;
  for (const Part& part : model.parts) {
    for (const std::uint32_t index : part.mesh.indices) {
      const glm::vec3 p(world_from_model * part.mesh.positions[index]);
      bounds.low = glm::min(bounds.low, p);
      bounds.high = glm::max(bounds.high, p);
    }
  }
  return bounds;
}

}  // namespace

float scale_to_one_metre(const Model& model) {
  const Bounds own = bounds_of(model, glm::mat4(1.0f));
  return 1.0f / glm::length(own.high - own.low);
}

Scene mesh_above_plate(const std::shared_ptr<const Model>& model, int picture,
                       std::mt19937& random) {
  const float scale = scale_to_one_metre(*model);
  glm::mat4 world_from_model =
      placed(glm::vec3(0.0f), glm::normalize(uniform_point(random, -1.0f, 1.0f)),
             uniform(random, 0.0f, 6.0f), glm::vec3(scale));
  const Bounds turned = bounds_of(*model, world_from_model);
  const glm::vec3 middle = (turned.low + turned.high) * 0.5f;
  world_from_model = placed({-middle.x, 0.1f - turned.low.y, -middle.z}) * world_from_model;

  Scene scene;
  scene.objects.push_back({.name = "plate", .model = model_of(square_mesh(3.0f)), .casts = false});
  scene.objects.push_back({.name = "mesh", .model = model, .world_from_model = world_from_model});
  glm::vec3 at = uniform_point(random, -1.0f, 1.0f);
  at.y = uniform(random, 1.5f, 2.5f);
  scene.lights.push_back({.name = "lamp", .position = glm::vec4(at, 1.0f)});
  if (picture % 2 == 1) scene.lights[0].position = glm::vec4(glm::normalize(at), 0.0f);
  return scene;
}

Camera camera_about(std::mt19937& random, int width, int height) {
  glm::vec3 eye = uniform_point(random, -1.0f, 1.0f);
  eye = glm::normalize(glm::vec3(eye.x, 0.0f, eye.z)) * 1.6f + glm::vec3(0.0f, 1.1f, 0.0f);
  return look(eye, {0.0f, 0.3f, 0.0f}, width, height);
}

void time_volumes(const Scene& scene, const Camera& camera, VolumeGeometry geometry,
                  VolumeTimes& times) {
  constexpr int kTimes = 6;
  TopologyCache topologies;
  VolumeMemory memory;
  raster::ExecuteMemory executing;
  const std::vector<PlacedObject> objects = place_objects(scene, camera, topologies);
  raster::DepthBuffer depth(camera.width, camera.height);
  raster::StencilBuffer stencil(camera.width, camera.height);
  double make_ms = 1e30, execute_ms = 1e30;
  for (int i = 0; i < kTimes; ++i) {
    ar::Stopwatch timer;
    const std::vector<PlacedVolume> volumes =
        make_volumes(objects, scene.lights[0], {}, {},
                     {.method = VolumeMethod::zfail,
                      .extrusion = {.kind = Extrusion::Kind::infinite},
                      .geometry = geometry,
                      .threads = 1,
                      .memory = &memory});
    const double made_ms = timer.lap_ms();
    raster::Frame frame;
    frame.begin_pass("surfaces and volumes", {.depth = &depth, .stencil = &stencil});
    frame.clear({.depth = 1.0f, .stencil = 0});
    raster::State state = surface_state();
    state.depth = raster::DepthState{};
    for (const PlacedObject& object : objects) draw_depth(frame, object, state);
    count_volumes(frame, volumes, {});
    timer.lap_ms();
    raster::execute(frame, {.threads = 1, .memory = &executing});
    const double executed_ms = timer.lap_ms();
    if (i == 0) continue;
    make_ms = std::min(make_ms, made_ms);
    execute_ms = std::min(execute_ms, executed_ms);
  }
  times.make_ms += make_ms;
  times.execute_ms += execute_ms;
}

}  // namespace gnomon::test
