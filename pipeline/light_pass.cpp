#include "pipeline/light_pass.h"

namespace gnomon::pipeline {

void add_light(raster::Frame& frame, const PlacedObject& object, const Scene& scene,
               const Camera& camera, const Light& light, const LightPassOptions& options) {
  const bool receives = object.object->receives;
  raster::State state = surface_state();
  state.depth = raster::DepthState{.func = raster::CompareFunc::equal, .write = false};
  if (receives)
    state.stencil = raster::StencilState::both({.func = raster::CompareFunc::equal,
                                                .read_mask = options.where.read_mask,
                                                .write_mask = options.where.write_mask,
                                                .pass = options.where.mark});
  state.color.write = {true, true, true, false};
  state.color.blend =
      raster::Blend{.src_color = options.factor, .dst_color = raster::BlendFactor::one};
  LightTerms terms{.diffuse = true, .specular = true, .lights = std::span(&light, 1)};
  if (receives) terms.shadow_maps = std::span(&options.shadow_map, 1);
  draw_lit(frame, object, scene, camera, terms, state, receives ? options.where.ref : 0);
}

}  // namespace gnomon::pipeline
