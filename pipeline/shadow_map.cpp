#include "pipeline/shadow_map.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "pipeline/displaced_caster.h"
#include "pipeline/silhouette.h"

namespace gnomon::pipeline {
namespace {

/// What a spot lights, if one map can show it.
std::optional<Rectangle> beam_of(const Light& light) {
  const double cosine = light.spot_cos_cutoff;
  if (light.position.w == 0.0f || !(cosine > 0.0)) return {};
  const double tangent = std::sqrt(1.0 - cosine * cosine) / cosine;
  if (!(tangent > 0.0 && tangent < kWidestMap)) return {};
  return Rectangle{glm::dvec2(-tangent), glm::dvec2(tangent)};
}

/// With the light inside, the averted faces are the ones that are seen.
bool is_thick(const PlacedObject& object, const glm::vec4& light, double texel_m) {
  const Topology& caster = *object.caster_topology;
  if (casts_both_sides(caster, light_in_model(light, object.object->world_from_model)))
    return false;
  const glm::dmat3 world(object.object->world_from_model);
  const double scale =
      std::min({glm::length(world[0]), glm::length(world[1]), glm::length(world[2])});
  return caster.thickness * scale >= 2.0 * texel_m;
}

std::shared_ptr<const Mesh> mesh_of(const Topology& topology) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = topology.positions;
  mesh->indices = topology.indices;
  return mesh;
}

}  // namespace

std::optional<MapPlan> plan_shadow_map(const Scene& scene, const Casters& casters,
                                       const Light& light, const Camera& camera,
                                       const MapSettings& settings) {
  // The same rules as for volumes.
  (void)light_in_model(light.position, glm::mat4(1.0f));
  const MapPlanner planner(scene, casters, light, camera, settings);
  if (!planner.has_casters()) return MapPlan{.empty = true};
  const glm::dvec3 at(light.position);
  if (const std::optional<Rectangle> beam = beam_of(light))
    return planner.plan(LightView::about(light, glm::normalize(glm::dvec3(light.spot_direction))),
                        beam);
  const glm::dvec3 aim = planner.middle_of_casters();
  if (light.position.w != 0.0f && aim == at) return {};
  return planner.plan(LightView::towards(light, aim));
}

raster::DepthBuffer& MapMemory::map(std::size_t number, int size, raster::DepthFormat format) {
  if (maps_.size() <= number) maps_.resize(number + 1);
  std::unique_ptr<raster::DepthBuffer>& map = maps_[number];
  if (!map || map->width() != size || map->format() != format)
    map = std::make_unique<raster::DepthBuffer>(size, size, format);
  return *map;
}

raster::DepthLookup record_shadow_map(raster::Frame& frame, std::span<const PlacedObject> objects,
                                      const Casters& casters, const std::string& name,
                                      const MapPlan& plan, raster::Filter filter,
                                      raster::DepthBuffer& map) {
  frame.begin_pass("shadow map: " + name, {.depth = &map});
  frame.clear({.depth = 1.0f});
  raster::State state = surface_state();
  state.depth = raster::DepthState{};
  state.depth_range.far = static_cast<float>(kMapDepthFar);
  for (const PlacedObject& object : objects) {
    if (!casters.contains(*object.object)) continue;
    // What of a closed body is turned from the light hides the same points, and never the lit side.
    // The map mirrors (LightView), so that side is the one that is in front here.
    // Of one that is turned inside out nobody can tell which it is.
    const Topology& caster = *object.caster_topology;
    const bool averted = caster.faults.closed_manifold() && caster.thickness >= 0.0;
    state.cull = averted ? raster::Cull::back : raster::Cull::none;
    state.polygon_offset =
        averted && is_thick(object, plan.light, plan.texel_m) ? plan.offset_of_thick : plan.offset;
    PlacedObject seen = object;
    seen.clip_from_model = plan.clip_from_world * object.object->world_from_model;
    MovedCaster moved;
    if (is_displaced(*object.object))
      seen.caster_meshes = {mesh_of(caster_for(object, plan.light, moved))};
    draw_caster_depth(frame, seen, state);
  }
  // From [-1, 1] to [0, 1], and to [0, kMapDepthFar].
  const auto half_depth = static_cast<float>(0.5 * kMapDepthFar);
  glm::mat4 to_map(0.5f);
  to_map[2][2] = half_depth;
  to_map[3] = {0.5f, 0.5f, half_depth, 1.0f};
  return {.map = &map, .map_from_position = to_map * plan.clip_from_world, .filter = filter};
}

}  // namespace gnomon::pipeline
