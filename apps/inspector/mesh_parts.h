// The named runs of a draw's triangles (raster::MeshPart).
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "raster/frame.h"

namespace gnomon::apps::inspector {

/// The name of the part that holds the triangle; empty if it has none.
inline std::string_view part_of(const raster::Draw& draw, std::uint32_t triangle) {
  // Parts are in order, and a later one that begins at the same triangle has it.
  const auto after = std::ranges::upper_bound(
      draw.parts, triangle, {}, [](const auto& part) { return part.first_index / 3; });
  return after == draw.parts.begin() ? std::string_view() : std::prev(after)->label;
}

}  // namespace gnomon::apps::inspector
