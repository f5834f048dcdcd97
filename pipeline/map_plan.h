// The settings that users of shadow maps tune by hand (Kuehl, section 5) - frustum, size, displace
// scale and offset - found from the scene.
// Invariant: a map holds every point that a visible receiver's shadow can come from; its texels are
// no coarser than the receivers' pixels unless the largest size is reached; a flat surface does not
// shadow itself, unless it is a thin part of a closed body that is thick in the mean. The reasons
// stand in map_plan.cpp.
#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/casters.h"
#include "pipeline/light_view.h"
#include "pipeline/map_settings.h"
#include "pipeline/scene.h"
#include "raster/state.h"

namespace gnomon::pipeline {

/// What one map is drawn with.
struct MapPlan {
  /// No caster can shadow a visible receiver: no map is needed.
  bool empty = false;
  /// Light::position.
  glm::vec4 light{0.0f};
  glm::mat4 clip_from_world{1.0f};
  int size = 0;
  /// Metres that a texel is wide at the farthest caster.
  double texel_m = 0.0;
  /// Of casters, and of those closed ones that are thick against a texel: of them the map holds the
  /// faces turned from the light, and every lit face lies before them by more than a texel's error.
  raster::PolygonOffset offset, offset_of_thick;
};

/// The casters' part of a map's depths. A power of two less than 1, so that float32 has it.
inline constexpr double kMapDepthFar = 1.0 - 1.0 / 1024.0;

/// Tangent of half the widest angle of view that one map serves, 80 degrees.
inline constexpr double kWidestMap = 5.67128181961771;

/// Plans the maps of one light. Refers to its arguments.
class MapPlanner {
 public:
  /// Errors (std::invalid_argument, as raster::require): a size out of 1 to 16384, a tangent that
  /// is not positive, a near plane that is not before the far one.
  /// Precondition: every object has a model; its indices, and its shadow model's, name positions.
  MapPlanner(const Scene& scene, const Casters& casters, const Light& light, const Camera& camera,
             const MapSettings& settings);

  /// Does any triangle cast?
  bool has_casters() const { return low_.x <= high_.x; }
  glm::dvec3 middle_of_casters() const { return (low_ + high_) * 0.5; }

  /// The map of a view, or of no more than a part of it. Absent: one map cannot serve the whole
  /// view (casters over more than 160 degrees of a point light's, or a visible receiver behind it).
  /// Errors (std::invalid_argument): a point light's near plane that is not before it.
  std::optional<MapPlan> plan(const LightView& view,
                              const std::optional<Rectangle>& part = {}) const;

 private:
  const Scene& scene_;
  const Casters& casters_;
  const Light& light_;
  const Camera& camera_;
  const MapSettings& settings_;
  /// Bounds of the casters in world space.
  glm::dvec3 low_, high_;
};

}  // namespace gnomon::pipeline
