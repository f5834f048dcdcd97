#include "pipeline/light_pass.h"

namespace gnomon::pipeline {

void add_light(raster::Frame& frame, const PlacedObject& object, const Scene& scene,
               const Camera& camera, const Light& light, raster::BlendFactor factor,
               const std::optional<raster::DepthLookup>& shadow_map) {
  raster::State state = surface_state();
  state.depth = raster::DepthState{.func = raster::CompareFunc::equal, .write = false};
  if (object.object->receives) {
    state.stencil = raster::StencilState::both(
        {.func = raster::CompareFunc::equal, .pass = raster::StencilOp::incr});
  }
  state.color.write = {true, true, true, false};
  state.color.blend = raster::Blend{.src_color = factor, .dst_color = raster::BlendFactor::one};
  LightTerms terms{.diffuse = true, .specular = true, .lights = std::span(&light, 1)};
  if (object.object->receives) terms.shadow_maps = std::span(&shadow_map, 1);
  draw_lit(frame, object, scene, camera, terms, state);
}

}  // namespace gnomon::pipeline
