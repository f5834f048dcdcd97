// Shadow maps (Williams 1978; Kuehl, section 4.1): the casters' depths as a light sees them, and
// the settings that Kuehl's users tune by hand - frustum, size, displace scale and offset - found
// from the scene.
// Invariant: a map holds every point that a visible receiver's shadow can come from; its texels are
// no coarser than the receivers' pixels unless the largest size is reached; a flat surface does not
// shadow itself. The reasons stand in shadow_map.cpp.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/map_settings.h"
#include "pipeline/placed_object.h"
#include "pipeline/scene.h"
#include "raster/buffers.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// What one light's map is drawn with.
struct MapPlan {
  /// No caster can shadow a visible receiver: the light needs no map.
  bool empty = false;
  glm::mat4 clip_from_world{1.0f};
  int size = 0;
  raster::PolygonOffset offset;
};

/// Finds what the settings leave open. Absent: one map cannot serve the light (the casters span
/// more than 160 degrees of a point light's view, or a visible receiver lies behind it).
/// Errors (std::invalid_argument, as raster::require): a size out of 1 to 16384, a tangent that is
/// not positive, a near plane that is not between 0 and the far one, a light as in light_in_model.
/// Preconditions: every object has a model whose indices name its positions.
std::optional<MapPlan> plan_shadow_map(const Scene& scene, const Light& light, const Camera& camera,
                                       const MapSettings& settings);

/// Depth buffers of maps, kept between frames; of one frame at a time: to record the next one may
/// free what an earlier one draws into.
class MapMemory {
 public:
  /// The number-th map, of this size and format, of any content.
  raster::DepthBuffer& map(std::size_t number, int size, raster::DepthFormat format);

 private:
  std::vector<std::unique_ptr<raster::DepthBuffer>> maps_;
};

/// Records the pass "shadow map: LIGHT" that draws all casters into `map`, and returns the lookup
/// from world space that gives the light's share.
/// Precondition: the map is of the plan's size; it outlives the execution of the frame.
raster::DepthLookup record_shadow_map(raster::Frame& frame, std::span<const PlacedObject> objects,
                                      const Light& light, const MapPlan& plan,
                                      raster::Filter filter, raster::DepthBuffer& map);

}  // namespace gnomon::pipeline
