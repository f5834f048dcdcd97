// A scene's surfaces as small triangular patches, which light comes from and shadows fall on
// (Gibson 2003, sections 3 and 4).
// Invariant: patches of one surface meet edge to edge, without T-junctions inside it; a vertex
// belongs to patches of one normal. Patches give and take light on the side that they are
// counter-clockwise from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/scene.h"

namespace gnomon::pipeline {

struct PatchVertex {
  glm::vec3 position{0.0f};
  /// Unit length.
  glm::vec3 normal{0.0f, 1.0f, 0.0f};
};

struct Patch {
  std::array<std::uint32_t, 3> vertices{};
  /// The centroid.
  glm::dvec3 center{0.0};
  /// Unit length.
  glm::dvec3 normal{0.0, 1.0, 0.0};
  double area_m2 = 0.0;
  /// Index in PatchModel::surfaces.
  std::uint32_t surface = 0;
  /// Far outside of the scene (the sun): it gives light, and neither takes nor hides any.
  bool distant = false;
};

struct PatchModel {
  std::vector<PatchVertex> vertices;
  std::vector<Patch> patches;
  /// What the patches come from: parts of objects, "OBJECT" or, of several, "OBJECT part N" from 0.
  std::vector<std::string> surfaces;
  /// No patch's edge is longer, in metres.
  double longest_edge_m = 0.0;
  /// Indices of surfaces that light of distant patches goes through.
  std::vector<std::uint32_t> clear_surfaces;

  /// Patches of the scene itself, which come before distant ones.
  std::size_t near_count() const {
    std::size_t count = patches.size();
    while (count > 0 && patches[count - 1].distant) --count;
    return count;
  }
  glm::dvec3 corner(const Patch& patch, std::size_t k) const {
    return glm::dvec3(vertices[patch.vertices[k]].position);
  }
  std::array<glm::dvec3, 3> corners(const Patch& patch) const {
    return {corner(patch, 0), corner(patch, 1), corner(patch, 2)};
  }
};

/// Makes a patch of three vertices that exist. Precondition: they span an area.
Patch make_patch(const PatchModel& model, const std::array<std::uint32_t, 3>& vertices,
                 std::uint32_t surface);

/// Halves the scene's triangles until they are about `count` patches: the longest edge that gives
/// no more than that, found by bisection to a thousandth; at least one patch a triangle. Triangles
/// without area are left out. An edge is cut or not by its length alone, so that triangles on both
/// sides agree. Errors: std::invalid_argument where the scene has no triangle with an area, or a
/// count is not in [1, 100000].
PatchModel make_patches(const Scene& scene, std::size_t count);

}  // namespace gnomon::pipeline
