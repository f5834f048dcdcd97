#include "pipeline/modulative_method.h"

#include <utility>

#include "pipeline/full_screen.h"
#include "pipeline/light_samples.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

void draw_shadow_quad(raster::Frame& frame, const glm::vec4& color) {
  raster::Draw quad = full_screen_quad(frame, "shadow quad");
  quad.state.depth = where_a_surface_is();
  quad.state.stencil = raster::StencilState::both({.func = raster::CompareFunc::not_equal,
                                                   .fail = raster::StencilOp::replace,
                                                   .depth_fail = raster::StencilOp::replace,
                                                   .pass = raster::StencilOp::replace});
  quad.state.color.write = {true, true, true, false};
  quad.state.color.blend = raster::Blend{.src_color = raster::BlendFactor::src_alpha,
                                         .dst_color = raster::BlendFactor::one_minus_src_alpha};
  quad.shading = raster::Flat{.color = color};
  frame.draw(std::move(quad));
}

}  // namespace

raster::Frame record_modulative(const Scene& scene, const Camera& camera,
                                const raster::Targets& targets, const ModulativeOptions& options) {
  raster::require(targets.color && targets.depth && targets.stencil,
                  "the modulative method needs colour, depth and stencil");
  TopologyCache own_topologies;
  const std::vector<PlacedObject> objects =
      place_objects(scene, camera, options.topologies ? *options.topologies : own_topologies);
  const std::vector<Light> lights = sample_lights(scene);
  VolumeOptions volume_options{.method = options.method,
                               .extrusion = options.extrusion,
                               .threads = options.threads,
                               .memory = options.volumes};
  const Receivers receivers = receivers_for(volume_options, scene);
  const std::optional<NearRegion> region = near_region(camera.clip_from_world);

  raster::Frame frame;
  frame.begin_pass("lit scene", targets);
  frame.clear({.color = options.background, .depth = 1.0f, .stencil = 0});
  raster::State surface = surface_state();
  surface.depth = raster::DepthState{};
  for (const PlacedObject& object : objects) {
    draw_lit(
        frame, object, scene, camera,
        {.ambient = true, .emission = true, .diffuse = true, .specular = true, .lights = lights},
        surface);
  }
  for (const Light& light : lights) {
    const Casters casters(scene, light);
    volume_options.casters = &casters;
    frame.begin_pass("shadow volumes: " + light.name, targets);
    count_volumes(frame, make_volumes(objects, light, receivers, region, volume_options),
                  {.in_batches = true, .casters_drawn = true, .light_name = light.name});
    frame.begin_pass("shadow quad: " + light.name, targets);
    draw_shadow_quad(frame, options.shadow_color);
  }
  return frame;
}

}  // namespace gnomon::pipeline
