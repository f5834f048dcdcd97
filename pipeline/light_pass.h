// The pass that adds one light's diffuse and specular terms where it is not in shadow.
#pragma once

#include <optional>

#include "pipeline/placed_object.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// Records `object` again on its visible fragments (depth EQUAL, depth kept), adding the light to
/// what is there, where the stencil is 0; an object that receives no shadows, everywhere. Alpha is
/// kept. `factor` scales what is added (dst_alpha: only where alpha is 1).
/// The stencil of a pixel that was lit is incremented: where two triangles have one depth in one
/// pixel, only the first is added, as only the first was drawn by depth LESS.
/// An object that receives shadows is lit as far as `shadow_map` lets it, if there is one.
void add_light(raster::Frame& frame, const PlacedObject& object, const Scene& scene,
               const Camera& camera, const Light& light,
               raster::BlendFactor factor = raster::BlendFactor::one,
               const std::optional<raster::DepthLookup>& shadow_map = std::nullopt);

}  // namespace gnomon::pipeline
