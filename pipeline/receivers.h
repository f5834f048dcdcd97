// How far a shadow volume has to go: far enough for every receiver and no further (Haller 2003,
// section 3.1.1, leaves that radius to the future).
// Invariant: a receiver point inside the infinite volume is inside the finite one; the proof stands
// in receivers.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/mesh.h"
#include "pipeline/scene.h"
#include "pipeline/topology.h"

namespace gnomon::pipeline {

/// Three corners in world space.
using WorldTriangle = std::array<glm::dvec3, 3>;

/// A caster's casting triangles in world space: corners, and three of them a triangle.
class CastingMesh {
 public:
  std::vector<glm::dvec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  /// Those triangles of the mesh whose `casting` is not 0 (Silhouette::casting), in memory that is
  /// used again.
  void assign(const Topology& topology, std::span<const std::int8_t> casting,
              const glm::mat4& world_from_model);

  WorldTriangle triangle(std::size_t t) const {
    return {corners[triangles[t][0]], corners[triangles[t][1]], corners[triangles[t][2]]};
  }

 private:
  std::vector<std::uint32_t> corner_of_;
};

/// World-space triangles of everything that receives a shadow, with a bounding box an object.
class Receivers {
 public:
  struct Group {
    glm::dvec3 low{0.0}, high{0.0};
    std::vector<WorldTriangle> triangles;
  };

  Receivers() = default;
  /// All objects of the scene that receive.
  explicit Receivers(const Scene& scene);
  /// Triangles with a corner that is not finite are left out.
  void add(const Model& model, const glm::mat4& world_from_model);

  std::span<const Group> groups() const { return groups_; }

 private:
  std::vector<Group> groups_;
};

/// How far a caster's silhouette is swept.
struct Reach {
  enum class Kind {
    /// No receiver lies in the volume: none is needed.
    none,
    /// From a point light L: v goes to L + amount * (v - L). In a direction: by `amount` metres.
    finite,
    /// The light touches the caster: no finite sweep is enough.
    unbounded
  };
  Kind kind = Kind::none;
  double amount = 0.0;
  bool operator==(const Reach&) const = default;
};

/// Share by which a finite volume goes on behind its farthest receiver, so that no receiver lies on
/// the back cap: 1/256 of the distance from the light (of the sweep, for a direction).
inline constexpr double kReachMargin = 1.0 / 256.0;

/// The reach that is enough for the receivers, for casting triangles in world space.
/// Precondition: light_world is a finite point (w = 1) or a direction (w = 0) that is not null.
Reach find_reach(const glm::vec4& light_world, const CastingMesh& casting,
                 const Receivers& receivers);

}  // namespace gnomon::pipeline
