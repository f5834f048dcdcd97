// What raster::compare_depth must return, written from raster/depth_lookup.h alone: float32
// operations as in reference/float32.h, every comparison with a stored depth in integers.
#pragma once

#include <glm/vec4.hpp>

#include "raster/depth_lookup.h"

namespace gnomon::reference {

float compare_depth(const raster::DepthLookup& lookup, const glm::vec4& position);

}  // namespace gnomon::reference
