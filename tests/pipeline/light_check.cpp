#include "tests/pipeline/light_check.h"

#include <vector>

#include "ar/stopwatch.h"
#include "pipeline/ray_reference.h"
#include "tests/pipeline/stencil_check.h"

namespace gnomon::test {

using namespace pipeline;

double draw_light(LightBuffers& buffers, LightMemory& memory, Scene scene, const Camera& camera,
                  ShadowMethod method, const MapSettings& settings) {
  scene.lights[0].shadow = method;
  scene.lights[0].map = settings;
  ar::Stopwatch timer;
  const raster::Frame frame =
      record_general(scene, camera, {&buffers.color, &buffers.depth, &buffers.stencil},
                     {.topologies = &memory.topologies,
                      .volumes = &memory.volumes,
                      .maps = &memory.maps,
                      .alias_free = &memory.alias_free,
                      .threads = 1});
  raster::execute(frame, {.threads = 1, .memory = &memory.executing});
  return timer.lap_ms();
}

LightCheck& LightCheck::operator+=(const LightCheck& other) {
  tested += other.tested;
  dark += other.dark;
  light += other.light;
  unexplained += other.unexplained;
  return *this;
}

LightCheck check_light(LightMemory& memory, const Scene& scene, const Camera& camera,
                       ShadowMethod method, const MapSettings& settings) {
  LightBuffers unlit(camera.width, camera.height), lit = unlit, drawn = unlit;
  Scene dark = scene;
  dark.lights[0].color = glm::vec3(0.0f);
  draw_light(unlit, memory, dark, camera, ShadowMethod::none);
  draw_light(lit, memory, scene, camera, ShadowMethod::none);
  draw_light(drawn, memory, scene, camera, method, settings);
  const glm::vec4 light = scene.lights[0].position;
  const RayReference rays(scene);
  const std::vector<RayReference::Sample> samples = rays.cast(pixel_rays(camera), light);
  LightCheck check;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const auto& sample = samples[static_cast<std::size_t>(y) * camera.width + x];
      if (!sample.hit.hit || sample.shadow.faces_away) continue;
      const std::uint32_t depth = drawn.depth.at(x, y);
      if (depth == drawn.depth.max_value() || lit.color.at(x, y) == unlit.color.at(x, y)) continue;
      ++check.tested;
      const bool is_dark = drawn.color.at(x, y) != lit.color.at(x, y);
      if (is_dark == sample.shadow.blocked) continue;
      ++(is_dark ? check.dark : check.light);
      check.unexplained += why(scene, rays, camera, light, x, y, depth, is_dark) == Reason::none;
    }
  }
  return check;
}

}  // namespace gnomon::test
