#include "ar/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "ar/error.h"
#include "ar/flat_normals.h"
#include "ar/gltf_document.h"
#include "ar/gltf_material.h"

namespace gnomon::ar {

namespace {

using gltf::Document;
using gltf::fail;

/// A node of the scene, in the order of a walk from the roots.
struct PlacedNode {
  int index = 0;
  glm::dmat4 world_from_node{1.0};
};

std::string node_place(const Document& document, int index) {
  const std::string& name = document.gltf.nodes[static_cast<std::size_t>(index)].name;
  return name.empty() ? fmt::format("node {}", index) : fmt::format("node {} '{}'", index, name);
}

double finite(const Document& document, double value, const std::string& place) {
  if (!std::isfinite(value))
    fail(document.path, fmt::format("{}: {} is not a finite number", place, value));
  return value;
}

glm::dvec3 vector_of(const Document& document, const std::vector<double>& v, glm::dvec3 absent,
                     const std::string& place) {
  if (v.empty()) return absent;
  if (v.size() != 3) fail(document.path, fmt::format("{}: {} values, not 3", place, v.size()));
  return {finite(document, v[0], place), finite(document, v[1], place),
          finite(document, v[2], place)};
}

glm::dmat4 parent_from_node(const Document& document, int index) {
  const tinygltf::Node& node = document.gltf.nodes[static_cast<std::size_t>(index)];
  const std::string place = node_place(document, index);
  glm::dmat4 m(1.0);
  if (!node.matrix.empty()) {
    if (node.matrix.size() != 16)
      fail(document.path, fmt::format("{}: matrix of {} values", place, node.matrix.size()));
    for (int i = 0; i < 16; ++i)
      m[i / 4][i % 4] =
          finite(document, node.matrix[static_cast<std::size_t>(i)], place + ": matrix");
    if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0)
      fail(document.path, place + ": matrix: the last row is not 0 0 0 1");
    return m;
  }
  const glm::dvec3 t =
      vector_of(document, node.translation, glm::dvec3(0.0), place + ": translation");
  const glm::dvec3 s = vector_of(document, node.scale, glm::dvec3(1.0), place + ": scale");
  glm::dquat q(1.0, 0.0, 0.0, 0.0);
  if (!node.rotation.empty()) {
    const std::string where = place + ": rotation";
    if (node.rotation.size() != 4)
      fail(document.path, fmt::format("{}: {} values, not 4", where, node.rotation.size()));
    const auto part = [&](std::size_t i) { return finite(document, node.rotation[i], where); };
    q = glm::dquat(part(3), part(0), part(1), part(2));
    const double length = glm::length(q);
    if (!(length > 1e-6 && length < 1e6))
      fail(document.path, fmt::format("{}: a quaternion of length {}", where, length));
    // An exact unit quaternion keeps its bits: dividing by a rounded 1 would not be exact.
    if (std::abs(length - 1.0) > 1e-12) q /= length;
  }
  const glm::dmat3 r = glm::mat3_cast(q);
  for (int c = 0; c < 3; ++c) m[c] = glm::dvec4(r[c] * s[c], 0.0);
  m[3] = glm::dvec4(t, 1.0);
  return m;
}

std::vector<int> root_nodes(const Document& document) {
  const tinygltf::Model& gltf = document.gltf;
  const int scene = gltf.defaultScene;
  if (scene >= 0 && static_cast<std::size_t>(scene) >= gltf.scenes.size())
    fail(document.path, fmt::format("scene {} is not one of {}", scene, gltf.scenes.size()));
  if (!gltf.scenes.empty())
    return gltf.scenes[scene < 0 ? 0 : static_cast<std::size_t>(scene)].nodes;
  std::vector<bool> is_child(gltf.nodes.size(), false);
  for (const tinygltf::Node& node : gltf.nodes)
    for (const int child : node.children)
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
        is_child[static_cast<std::size_t>(child)] = true;
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  return roots;
}

/// Walks the scene, parents first. glTF's nodes form trees: one that is reached twice is refused,
/// and so are cycles.
std::vector<PlacedNode> placed_nodes(const Document& document) {
  const auto& nodes = document.gltf.nodes;
  std::vector<bool> reached(nodes.size(), false);
  std::vector<PlacedNode> waiting, placed;
  const auto reach = [&](int index, const glm::dmat4& world_from_parent, const std::string& place) {
    if (index < 0 || static_cast<std::size_t>(index) >= nodes.size())
      fail(document.path, fmt::format("{}: node {} is not one of {}", place, index, nodes.size()));
    if (reached[static_cast<std::size_t>(index)])
      fail(document.path,
           fmt::format("{} is reached twice (again from {})", node_place(document, index), place));
    reached[static_cast<std::size_t>(index)] = true;
    const glm::dmat4 m = world_from_parent * parent_from_node(document, index);
    for (int i = 0; i < 16; ++i)
      finite(document, m[i / 4][i % 4], node_place(document, index) + ": transform");
    waiting.push_back({index, m});
  };
  const std::vector<int> roots = root_nodes(document);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root)
    reach(*root, glm::dmat4(1.0), "scene");
  while (!waiting.empty()) {
    const PlacedNode node = waiting.back();
    waiting.pop_back();
    placed.push_back(node);
    const auto& children = nodes[static_cast<std::size_t>(node.index)].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      reach(*child, node.world_from_node, node_place(document, node.index));
  }
  return placed;
}

/// Three corners a triangle, from a list, strip or fan (glTF 2.0, section 3.7.2.1).
std::vector<std::uint32_t> triangles(const Document& document, int mode,
                                     std::vector<std::uint32_t> corners, const std::string& place) {
  const std::size_t n = corners.size();
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (n % 3 != 0)
      fail(document.path, fmt::format("{}: {} corners are not whole triangles", place, n));
    return corners;
  }
  if (n < 3) fail(document.path, fmt::format("{}: {} corners are no triangle", place, n));
  std::vector<std::uint32_t> list;
  list.reserve(3 * (n - 2));
  for (std::size_t i = 0; i + 2 < n; ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
      list.insert(list.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    else
      list.insert(list.end(), {corners[i + 1], corners[i + 2], corners[0]});
  }
  return list;
}

/// Reads the primitives of one document.
class Reader {
 public:
  explicit Reader(Document document) : document_(std::move(document)), materials_(document_) {}

  GltfModel read() {
    for (const PlacedNode& placed : placed_nodes(document_)) add_node(placed);
    if (result_.model.parts.empty())
      fail(document_.path, result_.notes.empty()
                               ? std::string("no triangle in the scene")
                               : "no triangle in the scene: " + result_.notes.front());
    return std::move(result_);
  }

 private:
  void add_node(const PlacedNode& placed) {
    const tinygltf::Node& node = document_.gltf.nodes[static_cast<std::size_t>(placed.index)];
    if (node.mesh < 0) return;
    const auto& meshes = document_.gltf.meshes;
    if (static_cast<std::size_t>(node.mesh) >= meshes.size())
      fail(document_.path,
           fmt::format("{}: mesh {} is not one of {}", node_place(document_, placed.index),
                       node.mesh, meshes.size()));
    if (glm::determinant(glm::dmat3(placed.world_from_node)) == 0.0) {
      note(fmt::format("{}: left out, it is scaled to nothing",
                       node_place(document_, placed.index)));
      return;
    }
    const tinygltf::Mesh& mesh = meshes[static_cast<std::size_t>(node.mesh)];
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const std::string name = mesh.name.empty() ? "" : fmt::format(" '{}'", mesh.name);
      add_primitive(mesh.primitives[i], placed.world_from_node,
                    fmt::format("mesh {}{} primitive {}", node.mesh, name, i));
      // A primitive may have been left out.
      result_.part_nodes.resize(result_.model.parts.size(), node.name);
    }
  }

  void add_primitive(const tinygltf::Primitive& primitive, const glm::dmat4& world_from_node,
                     const std::string& place) {
    const int mode = primitive.mode;
    if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN)
      fail(document_.path, fmt::format("{}: mode {} is not one of 0 to 6", place, mode));
    if (mode < TINYGLTF_MODE_TRIANGLES) return note(place + ": points and lines are left out");
    const std::optional<int> position = attribute(primitive, "POSITION");
    if (!position) return note(place + ": without POSITION, left out");

    pipeline::Part part;
    const gltf::Surface surface = materials_.surface(primitive.material, place);
    part.material = surface.material;
    part.two_sided = surface.two_sided;
    read_positions(part.mesh, *position, world_from_node, place);
    read_corners(part.mesh, primitive, place);
    if (glm::determinant(glm::dmat3(world_from_node)) < 0.0)
      for (std::size_t i = 0; i + 2 < part.mesh.indices.size(); i += 3)
        std::swap(part.mesh.indices[i + 1], part.mesh.indices[i + 2]);
    read_texcoords(part, primitive, surface, place);
    read_colors(part.mesh, primitive, place);
    if (!read_normals(part.mesh, primitive, world_from_node, place)) make_flat(part.mesh);
    result_.model.parts.push_back(std::move(part));
  }

  static std::optional<int> attribute(const tinygltf::Primitive& primitive,
                                      const std::string& name) {
    const auto it = primitive.attributes.find(name);
    return it == primitive.attributes.end() ? std::nullopt : std::optional(it->second);
  }

  void note(const std::string& text) {
    if (result_.notes.size() < kMaxNotes) result_.notes.push_back(text);
  }

  /// What one file may unfold to through nodes that share meshes.
  void spend(std::size_t vertices, const std::string& place) {
    vertices_ += vertices;
    if (vertices_ > gltf::kMaxVertices)
      fail(document_.path,
           fmt::format("{}: more than {} vertices in all", place, gltf::kMaxVertices));
  }

  void read_positions(pipeline::Mesh& mesh, int accessor, const glm::dmat4& world_from_node,
                      const std::string& place) {
    const std::string where = place + " POSITION";
    spend(gltf::value_count(document_, accessor, where), where);
    const std::vector<float> values = gltf::read_floats(document_, accessor, 3, where);
    mesh.positions.reserve(values.size() / 3);
    for (std::size_t i = 0; i < values.size(); i += 3) {
      const glm::dvec4 p =
          world_from_node * glm::dvec4(values[i], values[i + 1], values[i + 2], 1.0);
      const glm::vec3 world(p);
      for (int c = 0; c < 3; ++c)
        if (!std::isfinite(world[c]))
          fail(document_.path, fmt::format("{}[{}] is {} when placed", where, i / 3, world[c]));
      mesh.positions.emplace_back(world, 1.0f);
    }
  }

  void read_corners(pipeline::Mesh& mesh, const tinygltf::Primitive& primitive,
                    const std::string& place) {
    const std::size_t count = mesh.positions.size();
    std::vector<std::uint32_t> corners;
    if (primitive.indices >= 0) {
      const std::string where = place + " indices";
      spend(gltf::value_count(document_, primitive.indices, where), where);
      corners = gltf::read_indices(document_, primitive.indices, where);
    } else {
      for (std::size_t i = 0; i < count; ++i) corners.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (corners[i] >= count)
        fail(document_.path, fmt::format("{}: index {} at place {} is not below the {} positions",
                                         place, corners[i], i, count));
    mesh.indices = triangles(document_, primitive.mode, std::move(corners), place);
  }

  void expect_count(std::size_t count, const pipeline::Mesh& mesh, const std::string& where) {
    if (count != mesh.positions.size())
      fail(document_.path,
           fmt::format("{}: {} values for {} positions", where, count, mesh.positions.size()));
  }

  void read_texcoords(pipeline::Part& part, const tinygltf::Primitive& primitive,
                      const gltf::Surface& surface, const std::string& place) {
    if (!surface.texture) return;
    const std::string name = fmt::format("TEXCOORD_{}", surface.texcoord_set);
    const std::optional<int> accessor = attribute(primitive, name);
    if (!accessor) return note(fmt::format("{}: texture left out, no {}", place, name));
    const std::string where = fmt::format("{} {}", place, name);
    expect_count(gltf::value_count(document_, *accessor, where), part.mesh, where);
    const std::vector<float> values = gltf::read_floats(document_, *accessor, 2, where);
    for (std::size_t i = 0; i < values.size(); i += 2)
      part.mesh.texcoords.emplace_back(values[i], values[i + 1]);
    part.texture = surface.texture;
  }

  void read_colors(pipeline::Mesh& mesh, const tinygltf::Primitive& primitive,
                   const std::string& place) {
    const std::optional<int> accessor = attribute(primitive, "COLOR_0");
    if (!accessor) return;
    const std::string where = place + " COLOR_0";
    expect_count(gltf::value_count(document_, *accessor, where), mesh, where);
    const int components = gltf::component_count(document_, *accessor, where);
    if (components != 3 && components != 4)
      fail(document_.path, fmt::format("{}: {} components, not 3 or 4", where, components));
    const std::vector<float> values = gltf::read_floats(document_, *accessor, components, where);
    for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(components))
      mesh.colors.emplace_back(gltf::display_from_linear({values[i], values[i + 1], values[i + 2]}),
                               1.0f);
  }

  /// False if the primitive has no usable normals.
  bool read_normals(pipeline::Mesh& mesh, const tinygltf::Primitive& primitive,
                    const glm::dmat4& world_from_node, const std::string& place) {
    const std::optional<int> accessor = attribute(primitive, "NORMAL");
    if (!accessor) {
      spend(mesh.indices.size(), place);
      return false;
    }
    const std::string where = place + " NORMAL";
    expect_count(gltf::value_count(document_, *accessor, where), mesh, where);
    const std::vector<float> values = gltf::read_floats(document_, *accessor, 3, where);
    const glm::dmat3 m = glm::transpose(glm::inverse(glm::dmat3(world_from_node)));
    for (std::size_t i = 0; i < values.size(); i += 3) {
      const glm::dvec3 n = m * glm::dvec3(values[i], values[i + 1], values[i + 2]);
      const double length = glm::length(n);
      if (!(length > 1e-12) || !std::isfinite(length)) {
        note(fmt::format("{}[{}] has no direction: flat normals instead", where, i / 3));
        mesh.normals.clear();
        spend(mesh.indices.size(), place);
        return false;
      }
      mesh.normals.emplace_back(n / length);
    }
    return true;
  }

  static constexpr std::size_t kMaxNotes = 100;
  Document document_;
  gltf::Materials materials_;
  GltfModel result_;
  std::size_t vertices_ = 0;
};

/// The middle of the box around a node's mesh. `budget` bounds the vertices that one file may make
/// this read.
glm::dvec3 center_of(const Document& document, const PlacedNode& placed, std::size_t& budget) {
  const tinygltf::Node& node = document.gltf.nodes[static_cast<std::size_t>(placed.index)];
  const glm::dvec3 origin(placed.world_from_node[3]);
  const auto& meshes = document.gltf.meshes;
  if (node.mesh < 0) return origin;
  const std::string place = node_place(document, placed.index);
  if (static_cast<std::size_t>(node.mesh) >= meshes.size())
    fail(document.path,
         fmt::format("{}: mesh {} is not one of {}", place, node.mesh, meshes.size()));
  std::optional<glm::dvec3> low, high;
  for (const auto& primitive : meshes[static_cast<std::size_t>(node.mesh)].primitives) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) continue;
    const std::size_t count = gltf::value_count(document, position->second, place);
    if (count > budget)
      fail(document.path,
           fmt::format("{}: more than {} vertices in all", place, gltf::kMaxVertices));
    budget -= count;
    const std::vector<float> values = gltf::read_floats(document, position->second, 3, place);
    for (std::size_t i = 0; i < values.size(); i += 3) {
      const glm::dvec3 p(placed.world_from_node *
                         glm::dvec4(values[i], values[i + 1], values[i + 2], 1.0));
      low = low ? glm::min(*low, p) : p;
      high = high ? glm::max(*high, p) : p;
    }
  }
  return low ? (*low + *high) / 2.0 : origin;
}

/// Reads the document that load() gives.
template <class Load>
GltfModel read_within_memory(const std::filesystem::path& path, Load load) {
  try {
    return Reader(load()).read();
  } catch (const std::bad_alloc&) {
    fail(path, "too large for this machine's memory");
  }
}

}  // namespace

GltfModel read_gltf(const std::filesystem::path& path) {
  return read_within_memory(path, [&] { return gltf::load_document(path); });
}

GltfModel read_gltf(const std::filesystem::path& path, std::span<const std::uint8_t> bytes) {
  return read_within_memory(path, [&] { return gltf::load_document(path, bytes); });
}

std::vector<GltfNode> read_gltf_nodes(const std::filesystem::path& path) {
  const Document document = gltf::load_document(path);
  std::vector<GltfNode> nodes;
  std::size_t budget = gltf::kMaxVertices;
  for (const PlacedNode& placed : placed_nodes(document)) {
    const auto i = static_cast<std::size_t>(placed.index);
    nodes.push_back({document.gltf.nodes[i].name, placed.world_from_node,
                     center_of(document, placed, budget),
                     i < document.node_extras.size() ? document.node_extras[i] : ""});
  }
  return nodes;
}

}  // namespace gnomon::ar
