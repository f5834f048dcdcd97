// A scene as a graph of nodes. Kuehl (section 4): shadows are nodes too, and a shadow node's caster
// is a node or a whole sub-tree (fpStencilShadow's Caster field), so that "plug and play" is to
// hang a node into the graph.
// Invariant: the graph says where things are, a Scene what the methods need; flatten() makes the
// one from the other anew whenever something has moved.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/map_settings.h"
#include "pipeline/mesh.h"
#include "pipeline/scene.h"

namespace gnomon::pipeline {

struct Node;
using NodePointer = std::shared_ptr<Node>;

/// Something that is seen.
struct Geometry {
  std::shared_ptr<const Model> model;
  Role role = Role::virtual_object;
  bool casts = true, receives = true;
  /// As in Object.
  std::shared_ptr<const Model> shadow_model = nullptr;
  float shadow_displace = 0.0f;
};

/// A light and its beam in the node's own space; its radius stays in metres of the world. Its
/// shadow_of_object is what flatten() finds.
struct LightSource {
  Light light;
};

/// Says who casts a light's shadow and how it is found. A light that no shadow node speaks of has
/// the shadows of all that cast, by Light::shadow.
struct Shadow {
  /// The node whose sub-tree casts; null: everything.
  NodePointer caster;
  /// A node with a light; null: every light.
  NodePointer light;
  ShadowMethod method = ShadowMethod::volumes;
  MapSettings map = {};
};

/// Every node places its children (as Performer's DCS); a group is a node with children alone. A
/// node may hang in several places, and is then in the scene several times.
struct Node {
  std::string name;
  glm::dmat4 parent_from_node{1.0};
  std::variant<std::monostate, Geometry, LightSource, Shadow> content;
  std::vector<NodePointer> children;
  /// Off: neither the node nor what hangs below it is in the scene (Performer's switch).
  bool on = true;
};

NodePointer make_node(std::string name, const glm::dmat4& parent_from_node = glm::dmat4(1.0));

/// The scene that the graph describes: objects and lights in the order of the graph (a node before
/// its children), with ambient light 0.3. An object or light is named by its node.
/// Errors (std::invalid_argument, as raster::require), with the node's name: a node that contains
/// itself or a null child; more than 1000 levels or a million places; a transform that is not
/// finite or not invertible; a geometry without a model; a caster or light that is not in the
/// graph, or a shadow's light that is none; two shadow nodes that give one object and light
/// different methods, or one light different maps.
Scene flatten(const Node& root);

}  // namespace gnomon::pipeline
