#include "pipeline/displaced_caster.h"

#include <cstddef>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/silhouette.h"

namespace gnomon::pipeline {

glm::vec4 displaced(const glm::vec4& corner, const glm::dvec4& light_model, double distance) {
  const glm::dvec3 at(corner), light(light_model);
  const glm::dvec3 away = light_model.w == 0.0 ? -light : at - light;
  const double length = glm::length(away);
  if (!(length > 0.0)) return corner;
  return glm::vec4(glm::vec3(at + away * (distance / length)), corner.w);
}

bool is_displaced(const Object& object) {
  return !object.casts_as_drawn() && object.shadow_displace != 0.0f;
}

const Topology& caster_for(const PlacedObject& object, const glm::vec4& light_world,
                           MovedCaster& memory) {
  const Topology& source = *object.caster_topology;
  if (!is_displaced(*object.object)) return source;
  if (memory.source != object.caster_topology) {
    memory.topology = source;
    memory.source = object.caster_topology;
  }
  const glm::dvec4 light = light_in_model(light_world, object.object->world_from_model);
  const double distance = object.object->shadow_displace;
  for (std::size_t i = 0; i < source.positions.size(); ++i)
    memory.topology.positions[i] = displaced(source.positions[i], light, distance);
  update_planes(memory.topology);
  return memory.topology;
}

Scene displace_casters(Scene scene, const glm::vec4& light_world) {
  for (Object& object : scene.objects) {
    if (!is_displaced(object)) continue;
    const glm::dvec4 light = light_in_model(light_world, object.world_from_model);
    Model model = *object.shadow_model;
    for (Part& part : model.parts)
      for (glm::vec4& p : part.mesh.positions) p = displaced(p, light, object.shadow_displace);
    object.shadow_model = std::make_shared<const Model>(std::move(model));
    object.shadow_displace = 0.0f;
  }
  return scene;
}

}  // namespace gnomon::pipeline
