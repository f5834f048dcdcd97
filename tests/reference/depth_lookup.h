// What raster::compare_depth must return, written from raster/depth_lookup.h alone: every float32
// operation as one in double that is then rounded (53 bits are more than twice 24 and two, so the
// second rounding changes nothing), every comparison with a stored depth in integers.
#pragma once

#include <glm/vec4.hpp>

#include "raster/depth_lookup.h"

namespace gnomon::reference {

float compare_depth(const raster::DepthLookup& lookup, const glm::vec4& position);

}  // namespace gnomon::reference
