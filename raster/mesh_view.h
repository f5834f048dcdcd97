// Borrowed indexed triangles. Positions are homogeneous; w = 0 is a point at infinity (legal
// everywhere).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace gnomon::raster {

/// Three indices a triangle. Attribute arrays are empty or as long as `positions`; every index is
/// below that length. A triangle with a position that is not finite draws nothing.
struct MeshView {
  std::span<const glm::vec4> positions;
  std::span<const std::uint32_t> indices;
  std::span<const glm::vec3> normals = {};
  std::span<const glm::vec4> colors = {};
  std::span<const glm::vec2> texcoords = {};
};

/// A run of a mesh's triangles that has a name, for people: it changes nothing that is drawn.
struct MeshPart {
  std::string label;
  /// Where it begins among the indices; it ends where the next one begins.
  std::uint32_t first_index = 0;
  bool operator==(const MeshPart&) const = default;
};

}  // namespace gnomon::raster
