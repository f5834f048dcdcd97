// Closed shadow volumes (Haller 2003, section 3.1.1 and figure 3): front cap, sides from the
// silhouette, back cap, in the caster's model space.
// Invariant: the triangles are a closed 2-chain for any caster mesh - every directed edge is run
// equally often both ways - because the volume is the sum of the casting triangles' prisms, whose
// inner walls cancel. Each vertex is swept once, so there are no cracks. The front cap has the bits
// of the caster's own vertices: drawn with the caster's clip_from_model it coincides with it.
// A cap may be left out where no count depends on it (count_volumes.cpp says where).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "pipeline/silhouette.h"
#include "pipeline/topology.h"
#include "raster/mesh_view.h"

namespace gnomon::pipeline {

/// Which caps a volume has beside its sides.
struct Caps {
  bool front = true, back = true;
  bool operator==(const Caps&) const = default;
};

/// Counter-clockwise from outside, in the order front cap, sides, back cap. Positions with w = 0
/// are points at infinity.
struct ShadowVolume {
  /// First those of the sides.
  std::vector<glm::vec4> positions;
  std::vector<std::uint32_t> indices;
  /// In the place of `indices`, of a volume that shares them with others, whose caps and sides are
  /// not apart (pipeline/degenerate_quads.h).
  std::shared_ptr<const std::vector<std::uint32_t>> shared_indices = nullptr;
  /// Indices (three a triangle) of the front cap and of the sides; the rest is the back cap.
  std::size_t front_cap_indices = 0, side_indices = 0;
  /// Positions that the sides use.
  std::size_t side_positions = 0;

  raster::MeshView view() const { return {positions, shared_indices ? *shared_indices : indices}; }
  /// The sides and the back cap, if there is one; of a volume that shares indices, all.
  raster::MeshView view_without_front_cap() const;
  /// The names of the view's triangles: "front cap", "sides", "back cap", as far as they are there
  /// and apart. Of the sides each quad's first triangle begins with its silhouette edge, and a quad
  /// whose far corners are one point has no second triangle.
  std::vector<raster::MeshPart> parts(bool front_cap) const;
  bool empty() const { return view().indices.empty(); }
};

/// Builds volumes one after the other in memory that it keeps. Not for use by several threads at
/// once.
/// Preconditions of all functions: `silhouette` belongs to `topology` and `light_model`
/// (light_in_model). `volume` is overwritten; what it has reserved is used again.
class VolumeBuilder {
 public:
  /// To infinity: v goes to the direction (v - L, 0), or to (-d, 0) for a direction. In the latter
  /// case the back cap is one point and falls away with every triangle that has it twice; those
  /// have no boundary, so the chain stays closed.
  void extrude_to_infinity(const Topology& topology, const Silhouette& silhouette,
                           const glm::dvec4& light_model, Caps caps, ShadowVolume& volume);

  /// v goes to L + amount * (v - L) for a point, by `amount` metres away from the light for a
  /// direction (Reach::amount).
  void extrude_by(const Topology& topology, const Silhouette& silhouette,
                  const glm::dvec4& light_model, double amount, Caps caps, ShadowVolume& volume);

  /// The paper's finite volume: each vertex moves radius_m metres (in the world) along its ray.
  /// Precondition: radius_m is positive and finite.
  void extrude_by_radius(const Topology& topology, const Silhouette& silhouette,
                         const glm::dvec4& light_model, const glm::mat4& world_from_model,
                         double radius_m, Caps caps, ShadowVolume& volume);

 private:
  /// Where a vertex and its swept copy are in the volume that is being built, if their generation
  /// is the builder's.
  struct Slot {
    std::uint32_t near_generation = 0, near = 0, far_generation = 0, far = 0;
  };
  template <class FarOf>
  class Assembler;
  template <class FarOf>
  void assemble(const Topology& topology, const Silhouette& silhouette, bool one_far_point,
                Caps caps, FarOf far_of, ShadowVolume& volume);

  std::vector<Slot> slots_;
  std::uint32_t generation_ = 0;
};

/// The same volumes in memory of their own.
ShadowVolume extrude_to_infinity(const Topology& topology, const Silhouette& silhouette,
                                 const glm::dvec4& light_model, Caps caps = {});
ShadowVolume extrude_by(const Topology& topology, const Silhouette& silhouette,
                        const glm::dvec4& light_model, double amount, Caps caps = {});
ShadowVolume extrude_by_radius(const Topology& topology, const Silhouette& silhouette,
                               const glm::dvec4& light_model, const glm::mat4& world_from_model,
                               double radius_m, Caps caps = {});

}  // namespace gnomon::pipeline
