#include "ar/scene_nodes.h"

#include <functional>
#include <stdexcept>

#include "ar/error.h"
#include "ar/file.h"

namespace gnomon::ar {

namespace {

using pipeline::Node;
using pipeline::NodePointer;

NodePointer find(const std::map<std::string, NodePointer>& nodes, const std::string& name) {
  const auto found = nodes.find(name);
  return found == nodes.end() ? nullptr : found->second;
}

}  // namespace

SceneNodes::SceneNodes(const SceneFile& scene, const std::vector<ObjectModels>& models)
    : file_(one_line(scene.file.string())),
      ambient_(scene.ambient),
      vertex_lighting_(scene.vertex_lighting),
      root_(pipeline::make_node("world")) {
  for (const SceneGroup& group : scene.groups) {
    const NodePointer node = pipeline::make_node(group.name, group.parent_from_group);
    carrier(group.attached_to)->children.push_back(node);
    groups_.emplace(group.name, node);
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const NodePointer node = pipeline::make_node(object.name, object.body_from_object);
    node->content = pipeline::Geometry{models[i].model,        object.role,
                                       object.casts,           object.receives,
                                       models[i].shadow_model, models[i].shadow_displace};
    carrier(object.attached_to)->children.push_back(node);
    objects_.emplace(object.name, node);
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const NodePointer node = pipeline::make_node(scene.lights[i].name);
    node->content = pipeline::LightSource{scene.lights[i]};
    carrier(scene.light_attached_to[i])->children.push_back(node);
    lights_.emplace(node->name, node);
  }
  add_casters(scene.casters);
}

NodePointer SceneNodes::carrier(const std::string& name) {
  if (name.empty()) return root_;
  if (const NodePointer group = find(groups_, name)) return group;
  NodePointer& body = bodies_[name];
  if (!body) {
    body = pipeline::make_node(name);
    body->on = false;
    root_->children.push_back(body);
  }
  return body;
}

void SceneNodes::add_casters(const std::vector<SceneCaster>& casters) {
  for (const SceneCaster& caster : casters) {
    NodePointer node = find(objects_, caster.node);
    if (!node && !caster.node.empty()) node = carrier(caster.node);
    const NodePointer shadow =
        pipeline::make_node("[caster]" + (caster.node.empty() ? "" : " " + caster.node));
    shadow->content =
        pipeline::Shadow{node, find(lights_, caster.light), caster.method, caster.map};
    root_->children.push_back(shadow);
  }
}

std::vector<std::string> SceneNodes::bodies() const {
  std::vector<std::string> names;
  for (const auto& [name, node] : bodies_) names.push_back(name);
  return names;
}

void SceneNodes::place(const std::string& body, const std::optional<glm::dmat4>& world_from_body) {
  const NodePointer node = find(bodies_, body);
  if (!node) return;
  node->on = world_from_body.has_value();
  if (world_from_body) node->parent_from_node = *world_from_body;
}

std::vector<std::string> SceneNodes::left_out() const {
  std::vector<std::string> names;
  const std::function<void(const Node&, bool)> walk = [&](const Node& node, bool on) {
    on = on && node.on;
    if (!on && std::holds_alternative<pipeline::Geometry>(node.content)) names.push_back(node.name);
    for (const NodePointer& child : node.children) walk(*child, on);
  };
  walk(*root_, true);
  return names;
}

pipeline::Scene SceneNodes::scene() const {
  try {
    pipeline::Scene scene = pipeline::flatten(*root_);
    scene.ambient = ambient_;
    scene.vertex_lighting = vertex_lighting_;
    return scene;
  } catch (const std::invalid_argument& error) {
    throw InputError(file_ + ": " + error.what());
  }
}

}  // namespace gnomon::ar
