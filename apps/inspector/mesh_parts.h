// The named runs of a draw's triangles (raster::MeshPart).
#pragma once

#include <cstdint>
#include <string_view>

#include "raster/frame.h"

namespace gnomon::apps::inspector {

/// The name of the part that holds the triangle; empty if it has none.
inline std::string_view part_of(const raster::Draw& draw, std::uint32_t triangle) {
  std::string_view name;
  for (const raster::MeshPart& part : draw.parts)
    if (part.first_index / 3 <= triangle) name = part.label;
  return name;
}

}  // namespace gnomon::apps::inspector
