#include "pipeline/shadow_volume.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

/// Collects the volume's triangles; `far_of` gives a vertex's swept position.
template <class FarOf>
class Assembler {
 public:
  Assembler(const Topology& topology, bool one_far_point, FarOf far_of)
      : topology_(topology),
        one_far_point_(one_far_point),
        far_of_(far_of),
        near_(topology.positions.size(), kUnused),
        far_(topology.positions.size(), kUnused) {}

  ShadowVolume assemble(const Silhouette& silhouette) {
    raster::require(silhouette.casting.size() == topology_.triangle_count(),
                    "a silhouette belongs to its topology");
    for (std::size_t t = 0; t < silhouette.casting.size(); ++t) {
      if (silhouette.casting[t] == 0) continue;
      const Corners c = corners(t, silhouette.casting[t]);
      add(near(c.a), near(c.b), near(c.c));
    }
    volume_.front_cap_indices = volume_.indices.size();
    for (const SilhouetteEdge& edge : silhouette.edges) {
      for (int i = 0; i < edge.multiplicity; ++i) {
        add(near(edge.to), near(edge.from), far(edge.from));
        add(near(edge.to), far(edge.from), far(edge.to));
      }
    }
    volume_.side_indices = volume_.indices.size() - volume_.front_cap_indices;
    for (std::size_t t = 0; t < silhouette.casting.size(); ++t) {
      if (silhouette.casting[t] == 0) continue;
      const Corners c = corners(t, silhouette.casting[t]);
      add(far(c.a), far(c.c), far(c.b));
    }
    return std::move(volume_);
  }

 private:
  struct Corners {
    std::uint32_t a, b, c;
  };

  Corners corners(std::size_t triangle, int casting) const {
    const std::uint32_t* i = &topology_.indices[3 * triangle];
    return casting > 0 ? Corners{i[0], i[1], i[2]} : Corners{i[0], i[2], i[1]};
  }
  std::uint32_t append(const glm::vec4& position) {
    volume_.positions.push_back(position);
    return static_cast<std::uint32_t>(volume_.positions.size() - 1);
  }
  std::uint32_t near(std::uint32_t vertex) {
    if (near_[vertex] == kUnused) near_[vertex] = append(topology_.positions[vertex]);
    return near_[vertex];
  }
  std::uint32_t far(std::uint32_t vertex) {
    std::uint32_t& slot = far_[one_far_point_ ? 0 : vertex];
    if (slot == kUnused) slot = append(far_of_(glm::dvec3(topology_.positions[vertex])));
    return slot;
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    // A triangle with a repeated corner has no boundary: leaving it out keeps the chain closed.
    if (a == b || b == c || c == a) return;
    volume_.indices.insert(volume_.indices.end(), {a, b, c});
  }

  const Topology& topology_;
  bool one_far_point_;
  FarOf far_of_;
  std::vector<std::uint32_t> near_, far_;
  ShadowVolume volume_;
};

}  // namespace

ShadowVolume extrude_to_infinity(const Topology& topology, const Silhouette& silhouette,
                                 const glm::dvec4& light_model) {
  const glm::dvec3 light(light_model);
  const bool directional = light_model.w == 0.0;
  const auto far_of = [&](const glm::dvec3& v) {
    return glm::vec4(glm::dvec4(directional ? -light : v - light, 0.0));
  };
  return Assembler(topology, directional, far_of).assemble(silhouette);
}

ShadowVolume extrude_by(const Topology& topology, const Silhouette& silhouette,
                        const glm::dvec4& light_model, double amount) {
  raster::require(std::isfinite(amount) && amount >= 0.0, "a sweep is finite and not negative");
  const glm::dvec3 light(light_model);
  const bool directional = light_model.w == 0.0;
  const auto far_of = [&](const glm::dvec3& v) {
    return glm::vec4(
        glm::dvec4(directional ? v - light * amount : light + (v - light) * amount, 1.0));
  };
  return Assembler(topology, false, far_of).assemble(silhouette);
}

ShadowVolume extrude_by_radius(const Topology& topology, const Silhouette& silhouette,
                               const glm::dvec4& light_model, const glm::mat4& world_from_model,
                               double radius_m) {
  raster::require(std::isfinite(radius_m) && radius_m > 0.0, "a radius is positive and finite");
  // A direction's unit is a metre already (light_in_model).
  if (light_model.w == 0.0) return extrude_by(topology, silhouette, light_model, radius_m);
  const glm::dvec3 light(light_model);
  const glm::dmat3 world(glm::dmat4{world_from_model});
  const auto far_of = [&](const glm::dvec3& v) {
    const double ray_m = glm::length(world * (v - light));
    return glm::vec4(glm::dvec4(v + (v - light) * (radius_m / ray_m), 1.0));
  };
  return Assembler(topology, false, far_of).assemble(silhouette);
}

}  // namespace gnomon::pipeline
