// How a light's shadow map is made. What is absent is found from scene and camera
// (pipeline/shadow_map.h).
#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "raster/buffers.h"
#include "raster/state.h"
#include "raster/texture.h"

namespace gnomon::pipeline {

struct MapSettings {
  /// Texels a side.
  std::optional<int> size;
  /// Tangent of half a point light's angle of view about the casters' middle (1 is 90 degrees). By
  /// itself the map gets the rectangle that casters and receivers need.
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
};

}  // namespace gnomon::pipeline
