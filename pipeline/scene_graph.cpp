#include "pipeline/scene_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace gnomon::pipeline {
namespace {

/// A graph deeper than this is refused: it is walked by recursion.
constexpr std::size_t kDeepest = 1000;
/// A node that hangs in two places has its children twice: they could double at every level.
constexpr std::size_t kMostPlaces = 1'000'000;

[[noreturn]] void refuse(const Node& node, const char* what) {
  throw std::invalid_argument("node '" + node.name + "': " + what);
}

void require_transform(const Node& node) {
  const glm::dmat4& m = node.parent_from_node;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) refuse(node, "its transform is not finite");
  if (glm::determinant(glm::dmat3(m)) == 0.0) refuse(node, "its transform cannot be inverted");
}

/// Nested transforms may leave float32's range.
void require_in_range(const Node& node, const glm::dmat4& world_from_node) {
  const glm::mat4 world(world_from_node);
  const double determinant = glm::determinant(glm::dmat3(glm::dmat4(world)));
  const float float_determinant = glm::determinant(glm::mat3(world));
  if (!std::isfinite(determinant) || !std::isfinite(float_determinant) || float_determinant == 0.0f)
    refuse(node, "with all above it, its transform is out of range");
}

/// Without a length it stays what it is: whoever uses it refuses it.
glm::vec3 turned(const glm::dmat4& world_from_node, const glm::vec3& direction) {
  const glm::dvec3 world = glm::dmat3(world_from_node) * glm::dvec3(direction);
  const double length = glm::length(world);
  return length > 0.0 ? glm::vec3(world / length) : direction;
}

Light in_world(const Node& node, const glm::dmat4& world_from_node) {
  Light light = std::get<LightSource>(node.content).light;
  light.name = node.name;
  light.shadow_of_object.clear();
  light.position = light.position.w == 0.0f
                       ? glm::vec4(turned(world_from_node, glm::vec3(light.position)), 0.0f)
                       : glm::vec4(glm::vec3(world_from_node * glm::dvec4(light.position)), 1.0f);
  light.spot_direction = turned(world_from_node, light.spot_direction);
  return light;
}

using Path = std::vector<const Node*>;

bool passes(const Path& path, const NodePointer& node) {
  return !node || std::ranges::find(path, node.get()) != path.end();
}

class Flattener {
 public:
  Scene flatten(const Node& root) {
    walk(root, glm::dmat4(1.0), true);
    for (const Node* shadow : shadows_) check(*shadow);
    for (std::size_t light = 0; light < scene_.lights.size(); ++light) give_shadows(light);
    return std::move(scene_);
  }

 private:
  /// `on`: is everything above?
  void walk(const Node& node, const glm::dmat4& world_from_parent, bool on) {
    if (std::ranges::find(path_, &node) != path_.end()) refuse(node, "it contains itself");
    if (path_.size() == kDeepest) refuse(node, "it lies more than 1000 nodes deep");
    if (++walked_ > kMostPlaces) refuse(node, "more than a million places in the graph");
    require_transform(node);
    const glm::dmat4 world_from_node = world_from_parent * node.parent_from_node;
    path_.push_back(&node);
    nodes_.push_back(&node);
    on = on && node.on;
    if (on) add(node, world_from_node);
    for (const NodePointer& child : node.children) {
      if (!child) refuse(node, "a child is null");
      walk(*child, world_from_node, on);
    }
    path_.pop_back();
  }

  void add(const Node& node, const glm::dmat4& world_from_node) {
    if (const auto* geometry = std::get_if<Geometry>(&node.content)) {
      if (!geometry->model) refuse(node, "a geometry has a model");
      require_in_range(node, world_from_node);
      scene_.objects.push_back({node.name, geometry->role, geometry->model,
                                glm::mat4(world_from_node), geometry->casts, geometry->receives,
                                geometry->shadow_model, geometry->shadow_displace});
      object_paths_.push_back(path_);
    } else if (std::holds_alternative<LightSource>(node.content)) {
      scene_.lights.push_back(in_world(node, world_from_node));
      light_paths_.push_back(path_);
    } else if (std::holds_alternative<Shadow>(node.content)) {
      shadows_.push_back(&node);
    }
  }

  bool in_graph(const NodePointer& node) const {
    return !node || std::ranges::find(nodes_, node.get()) != nodes_.end();
  }

  void check(const Node& node) const {
    const Shadow& shadow = std::get<Shadow>(node.content);
    if (!in_graph(shadow.caster)) refuse(node, "its caster is not in the graph");
    if (!in_graph(shadow.light)) refuse(node, "its light is not in the graph");
    if (shadow.light && !std::holds_alternative<LightSource>(shadow.light->content))
      refuse(node, "its light is a node without a light");
  }

  void give_shadows(std::size_t light) {
    std::vector<std::optional<ShadowMethod>> methods(scene_.objects.size());
    const MapSettings* map = nullptr;
    bool spoken_of = false;
    for (const Node* node : shadows_) {
      const Shadow& shadow = std::get<Shadow>(node->content);
      if (shadow.light && shadow.light.get() != light_paths_[light].back()) continue;
      spoken_of = true;
      if (shadow.method == ShadowMethod::map) {
        if (map && *map != shadow.map) refuse(*node, "its light has a map of other settings");
        map = &shadow.map;
      }
      for (std::size_t object = 0; object < methods.size(); ++object) {
        if (!passes(object_paths_[object], shadow.caster)) continue;
        if (methods[object].value_or(shadow.method) != shadow.method)
          refuse(*node, "another shadow node gives a caster another method");
        methods[object] = shadow.method;
      }
    }
    if (!spoken_of) return;
    if (map) scene_.lights[light].map = *map;
    for (const std::optional<ShadowMethod>& method : methods)
      scene_.lights[light].shadow_of_object.push_back(method.value_or(ShadowMethod::none));
  }

  Scene scene_;
  std::size_t walked_ = 0;
  Path path_;
  /// Every node once for each place it hangs in.
  std::vector<const Node*> nodes_, shadows_;
  std::vector<Path> object_paths_, light_paths_;
};

}  // namespace

NodePointer make_node(std::string name, const glm::dmat4& parent_from_node) {
  auto node = std::make_shared<Node>();
  node->name = std::move(name);
  node->parent_from_node = parent_from_node;
  return node;
}

Scene flatten(const Node& root) { return Flattener().flatten(root); }

}  // namespace gnomon::pipeline
