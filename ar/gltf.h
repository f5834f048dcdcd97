// Models from glTF 2.0 files (.glb, .gltf): triangles placed by their nodes, with normals, texture
// coordinates, colours and a fixed-function material. What is read and how materials are mapped:
// docs/models.md. Trusts nothing: every index, size and offset is checked against the buffers;
// other files are read only from the model's own folder. Source: Khronos glTF 2.0 specification.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "pipeline/mesh.h"

namespace gnomon::ar {

/// A model and what was left out of it.
struct GltfModel {
  pipeline::Model model;
  /// The node that each part comes from.
  std::vector<std::string> part_nodes;
  /// One sentence each: primitives, textures or nodes that were not used, and why.
  std::vector<std::string> notes;
};

/// A node of the scene that is shown.
struct GltfNode {
  std::string name;
  glm::dmat4 world_from_node{1.0};
  /// The middle of the box around its own mesh in the world; its origin if it has none.
  glm::dvec3 center_m{0.0};
  /// The node's `extras` as JSON text; empty without.
  std::string extras;
};

/// Reads the triangles of the file's scene (its default one, else the first; all root nodes if it
/// has none), in metres, in the file's own world frame. Each part is one primitive of one node.
/// A node's transform is applied in double and rounded once, by the same rule for every vertex:
/// equal positions stay equal, so a mesh that was closed stays closed. Skins and morphs stay at
/// rest. Throws InputError: a damaged file, a reference outside its target, a position that is not
/// finite, a node reached twice, a required extension that is not read, no triangle at all. Holds
/// afterwards: every mesh has normals; every index is below the number of positions.
GltfModel read_gltf(const std::filesystem::path& path);
/// The same where the file's own bytes are at hand.
GltfModel read_gltf(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

/// The nodes of the file's scene, parents before children. Throws InputError as read_gltf does,
/// except that a file without triangles is welcome.
std::vector<GltfNode> read_gltf_nodes(const std::filesystem::path& path);

}  // namespace gnomon::ar
