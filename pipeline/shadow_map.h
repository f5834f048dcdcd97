// Shadow maps (Williams 1978; Kuehl, section 4.1): the casters' depths as a light sees them, looked
// up where a light is added. How a map is planned: pipeline/map_plan.h.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/casters.h"
#include "pipeline/map_plan.h"
#include "pipeline/map_settings.h"
#include "pipeline/placed_object.h"
#include "pipeline/scene.h"
#include "raster/buffers.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// Plans one map for a light: about a spot's axis, or else towards the casters' middle.
/// Absent: one map cannot serve it (MapPlanner::plan). Errors: as MapPlanner, and a light as in
/// light_in_model.
std::optional<MapPlan> plan_shadow_map(const Scene& scene, const Casters& casters,
                                       const Light& light, const Camera& camera,
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

/// Records the pass "shadow map: NAME" that draws the casters into `map`, and returns the lookup
/// from world space that gives the light's share.
/// Preconditions: the plan is not empty, the map is of its size; it outlives the execution of the
/// frame.
raster::DepthLookup record_shadow_map(raster::Frame& frame, std::span<const PlacedObject> objects,
                                      const Casters& casters, const std::string& name,
                                      const MapPlan& plan, raster::Filter filter,
                                      raster::DepthBuffer& map);

}  // namespace gnomon::pipeline
