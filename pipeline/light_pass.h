// The pass that adds one light's diffuse and specular terms where it is not in shadow.
#pragma once

#include <cstdint>
#include <optional>

#include "pipeline/placed_object.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// Which pixels are lit, by their stencil, and how a pixel that was lit is marked: where two
/// triangles have one depth in one pixel, only the first may be added, as only the first was drawn
/// by depth LESS. By itself: where the stencil is 0, which is then incremented.
struct LitWhere {
  int ref = 0;
  std::uint8_t read_mask = 0xff, write_mask = 0xff;
  raster::StencilOp mark = raster::StencilOp::incr;
};

struct LightPassOptions {
  LitWhere where = {};
  /// Scales what is added (dst_alpha: only where alpha is 1).
  raster::BlendFactor factor = raster::BlendFactor::one;
  /// What lets the light through to an object that receives shadows.
  std::optional<raster::DepthLookup> shadow_map = {};
};

/// Records `object` again on its visible fragments (depth EQUAL, depth kept), adding the light to
/// what is there; an object that receives no shadows, whatever the stencil is. Alpha is kept.
void add_light(raster::Frame& frame, const PlacedObject& object, const Scene& scene,
               const Camera& camera, const Light& light, const LightPassOptions& options = {});

}  // namespace gnomon::pipeline
