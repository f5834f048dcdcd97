#include "pipeline/general_method.h"

#include "pipeline/light_pass.h"
#include "pipeline/light_samples.h"
#include "raster/check.h"

namespace gnomon::pipeline {

raster::Frame record_general(const Scene& scene, const Camera& camera,
                             const raster::Targets& targets, const GeneralOptions& options) {
  raster::require(targets.color && targets.depth && targets.stencil,
                  "the general method needs colour, depth and stencil");
  TopologyCache own_topologies;
  const std::vector<PlacedObject> objects =
      place_objects(scene, camera, options.topologies ? *options.topologies : own_topologies);
  const std::vector<Light> lights = sample_lights(scene);
  const std::optional<NearRegion> region = near_region(camera.clip_from_world);
  const VolumeOptions volume_options{
      .method = options.method,
      .extrusion = options.extrusion,
      .all_caps = options.all_caps,
      .counts = options.appendix_letter ? Counts::everywhere : options.counts,
      .view =
          View{camera.clip_from_world, targets.width(), targets.height(), targets.depth->format()},
      .threads = options.threads,
      .memory = options.volumes};
  const Receivers receivers = receivers_for(volume_options, scene);

  raster::Frame frame;
  frame.begin_pass("ambient pass", targets);
  frame.clear({.color = options.background, .depth = 1.0f, .stencil = 0});
  raster::State surface = surface_state();
  surface.depth = raster::DepthState{};
  for (const PlacedObject& object : objects) {
    draw_lit(frame, object, scene, camera, {.ambient = true, .emission = true}, surface);
  }
  std::size_t map_number = 0;
  for (const Light& light : lights) {
    const std::string suffix = lights.size() > 1 ? ": " + light.name : "";
    std::optional<raster::DepthLookup> shadow_map;
    std::optional<MapPlan> plan;
    if (light.shadow == ShadowMethod::map) {
      raster::require(options.maps != nullptr, "shadow maps need memory");
      plan = plan_shadow_map(scene, light, camera, light.map);
    }
    if (plan && !plan->empty) {
      raster::DepthBuffer& map = options.maps->map(map_number++, plan->size, light.map.format);
      shadow_map = record_shadow_map(frame, objects, light, *plan, light.map.filter, map);
    }
    const bool counts =
        light.shadow == ShadowMethod::volumes || (light.shadow == ShadowMethod::map && !plan);
    frame.begin_pass((counts ? "shadow volumes" : "no volumes") + suffix, targets);
    frame.clear({.stencil = 0});
    if (counts)
      count_volumes(frame, make_volumes(objects, light, receivers, region, volume_options),
                    {.appendix_letter = options.appendix_letter,
                     .casters_drawn = !options.all_caps,
                     .light_name = light.name});
    frame.begin_pass("lit pass" + suffix, targets);
    for (const PlacedObject& object : objects)
      add_light(frame, object, scene, camera, light, raster::BlendFactor::one, shadow_map);
  }
  return frame;
}

}  // namespace gnomon::pipeline
