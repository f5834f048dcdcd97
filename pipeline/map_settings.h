// How a light's shadow map is made. What is absent is found from scene and camera
// (pipeline/shadow_map.h).
#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec2.hpp>

#include "raster/buffers.h"
#include "raster/state.h"
#include "raster/texture.h"

namespace gnomon::pipeline {

/// One map, or one for each side of a cube about a point light; automatic: one where one serves.
enum class MapSides : std::uint8_t { automatic, one, six };

struct MapSettings {
  MapSides sides = MapSides::automatic;
  /// Texels a side.
  std::optional<int> size;
  /// Tangent of half a point light's angle of view about the casters' middle, or a spot's axis (1
  /// is 90 degrees); of one map. By itself the map gets the rectangle that casters and receivers
  /// need.
  std::optional<float> fov_tangent;
  /// Near and far plane, in metres from the light; for a light at infinity, along its direction
  /// from the casters' middle.
  std::optional<glm::vec2> near_far_m;
  /// Added to the map's depths: Performer's displace scale and offset.
  std::optional<raster::PolygonOffset> offset;
  /// nearest: hard edges; linear: 2x2 percentage-closer filtering.
  raster::Filter filter = raster::Filter::nearest;
  raster::DepthFormat format = raster::DepthFormat::d24;
  /// Of the size that is found.
  int largest_size = 4096;
  bool operator==(const MapSettings&) const = default;
};

}  // namespace gnomon::pipeline
