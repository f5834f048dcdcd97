// Meshes and models as the shadow methods see them: owned memory, no file.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "raster/mesh_view.h"
#include "raster/shading.h"

namespace gnomon::pipeline {

/// Indexed triangles, counter-clockwise seen from outside. Positions have w = 1. Normals, texture
/// coordinates and colours are absent (empty) or one a position.
struct Mesh {
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec4> colors;

  raster::MeshView view() const { return {positions, indices, normals, colors, texcoords}; }
  std::size_t triangle_count() const { return indices.size() / 3; }
};

/// A mesh with one material.
struct Part {
  Mesh mesh;
  raster::Material material;
  std::shared_ptr<const raster::Texture> texture;
  bool two_sided = false;
};

/// What one model file holds: parts in the model's own frame (metres).
struct Model {
  std::vector<Part> parts;
};

}  // namespace gnomon::pipeline
