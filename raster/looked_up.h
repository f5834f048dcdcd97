// The depth buffers that a command reads as textures.
#pragma once

#include <variant>

#include "raster/frame.h"

namespace gnomon::raster {

/// Calls body(map) for each depth buffer that the command looks up.
template <class Body>
void for_each_map(const Command& command, Body body) {
  const Draw* draw = std::get_if<Draw>(&command);
  if (!draw) return;
  if (const Flat* flat = std::get_if<Flat>(&draw->shading)) {
    if (flat->depth_lookup) body(flat->depth_lookup->map);
    return;
  }
  for (const Light& light : std::get<Lit>(draw->shading).lights)
    if (light.shadow_map) body(light.shadow_map->map);
}

}  // namespace gnomon::raster
