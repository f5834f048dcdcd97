#include "pipeline/shadow_volume.h"

#include <algorithm>

#include <glm/vec3.hpp>

#include "pipeline/swept_point.h"
#include "raster/check.h"

namespace gnomon::pipeline {

raster::MeshView ShadowVolume::view_without_front_cap() const {
  if (shared_indices) return view();
  const std::span<const glm::vec4> all(positions);
  const bool sides_only = indices.size() == front_cap_indices + side_indices;
  return {sides_only ? all.first(side_positions) : all,
          std::span(indices).subspan(front_cap_indices)};
}

std::vector<raster::MeshPart> ShadowVolume::parts(bool front_cap) const {
  std::vector<raster::MeshPart> out;
  if (shared_indices) return out;
  std::uint32_t begin = 0;
  const auto add = [&](const char* label, std::size_t count) {
    if (count > 0) out.push_back({label, begin});
    begin += static_cast<std::uint32_t>(count);
  };
  if (front_cap) add("front cap", front_cap_indices);
  add("sides", side_indices);
  add("back cap", indices.size() - front_cap_indices - side_indices);
  return out;
}

/// Collects a volume's triangles; `far_of` gives a vertex's swept position.
template <class FarOf>
class VolumeBuilder::Assembler {
 public:
  Assembler(const Topology& topology, const Silhouette& silhouette, bool one_far_point, Caps caps,
            FarOf far_of, std::vector<Slot>& slots, std::uint32_t generation, ShadowVolume& volume)
      : topology_(topology),
        silhouette_(silhouette),
        one_far_point_(one_far_point),
        caps_(caps),
        far_of_(far_of),
        slots_(slots),
        generation_(generation),
        volume_(volume) {}

  void assemble() {
    const std::size_t front = reserve();
    // The sides first, so that their positions are together.
    next_ = volume_.indices.data() + front;
    add_sides();
    volume_.side_positions = volume_.positions.size();
    std::uint32_t* const back = next_;
    next_ = volume_.indices.data();
    if (caps_.front) add_front_cap();
    next_ = back;
    if (has_back_cap()) add_back_cap();
  }

 private:
  struct Corners {
    std::uint32_t a, b, c;
  };

  /// A back cap that is one point has triangles with repeated corners only.
  bool has_back_cap() const { return caps_.back && !one_far_point_; }

  /// Makes room for exactly all indices and returns how many are the front cap's.
  std::size_t reserve() {
    const auto& casting = silhouette_.casting;
    const bool any_cap = caps_.front || has_back_cap();
    const std::size_t idle =
        any_cap ? static_cast<std::size_t>(std::count(casting.begin(), casting.end(), 0)) : 0;
    const std::size_t cap = any_cap ? 3 * (casting.size() - idle) : 0;
    std::size_t sides = 0;
    for (const SilhouetteEdge& edge : silhouette_.edges) {
      sides += (one_far_point_ ? 3 : 6) * static_cast<std::size_t>(edge.multiplicity);
    }
    const std::size_t front = caps_.front ? cap : 0;
    volume_.shared_indices = nullptr;
    volume_.front_cap_indices = front;
    volume_.side_indices = sides;
    volume_.indices.resize(front + sides + (has_back_cap() ? cap : 0));
    volume_.positions.clear();
    // The silhouette is a boundary, so an edge ends wherever one begins: it has no more vertices
    // than edges.
    const std::size_t vertices =
        std::min(any_cap ? cap : silhouette_.edges.size(), topology_.positions.size());
    volume_.positions.reserve(2 * vertices);
    return front;
  }

  void add_sides() {
    for (const SilhouetteEdge& edge : silhouette_.edges) {
      const std::uint32_t to = near(edge.to), from = near(edge.from);
      const std::uint32_t far_from = far(edge.from), far_to = far(edge.to);
      for (int i = 0; i < edge.multiplicity; ++i) {
        add(to, from, far_from);
        // A triangle with a repeated corner has no boundary: leaving it out keeps the chain closed.
        if (!one_far_point_) add(to, far_from, far_to);
      }
    }
  }
  void add_front_cap() {
    for_each_casting([this](const Corners& c) { add(near(c.a), near(c.b), near(c.c)); });
  }
  void add_back_cap() {
    for_each_casting([this](const Corners& c) { add(far(c.a), far(c.c), far(c.b)); });
  }

  template <class Visit>
  void for_each_casting(Visit visit) const {
    for (std::size_t t = 0; t < silhouette_.casting.size(); ++t) {
      const int casting = silhouette_.casting[t];
      if (casting == 0) continue;
      const std::uint32_t* i = &topology_.indices[3 * t];
      visit(casting > 0 ? Corners{i[0], i[1], i[2]} : Corners{i[0], i[2], i[1]});
    }
  }
  std::uint32_t append(const glm::vec4& position) {
    volume_.positions.push_back(position);
    return static_cast<std::uint32_t>(volume_.positions.size() - 1);
  }
  std::uint32_t near(std::uint32_t vertex) {
    Slot& slot = slots_[vertex];
    if (slot.near_generation != generation_) {
      slot.near_generation = generation_;
      slot.near = append(topology_.positions[vertex]);
    }
    return slot.near;
  }
  std::uint32_t far(std::uint32_t vertex) {
    Slot& slot = slots_[one_far_point_ ? 0 : vertex];
    if (slot.far_generation != generation_) {
      slot.far_generation = generation_;
      slot.far = append(far_of_(glm::dvec3(topology_.positions[vertex])));
    }
    return slot.far;
  }
  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    next_[0] = a;
    next_[1] = b;
    next_[2] = c;
    next_ += 3;
  }

  const Topology& topology_;
  const Silhouette& silhouette_;
  const bool one_far_point_;
  const Caps caps_;
  FarOf far_of_;
  std::vector<Slot>& slots_;
  const std::uint32_t generation_;
  ShadowVolume& volume_;
  std::uint32_t* next_ = nullptr;
};

template <class FarOf>
void VolumeBuilder::assemble(const Topology& topology, const Silhouette& silhouette,
                             bool one_far_point, Caps caps, FarOf far_of, ShadowVolume& volume) {
  raster::require(silhouette.casting.size() == topology.triangle_count(),
                  "a silhouette belongs to its topology");
  if (slots_.size() < topology.positions.size()) slots_.resize(topology.positions.size());
  if (++generation_ == 0) {
    std::fill(slots_.begin(), slots_.end(), Slot{});
    generation_ = 1;
  }
  Assembler<FarOf>(topology, silhouette, one_far_point, caps, far_of, slots_, generation_, volume)
      .assemble();
}

void VolumeBuilder::extrude_to_infinity(const Topology& topology, const Silhouette& silhouette,
                                        const glm::dvec4& light_model, Caps caps,
                                        ShadowVolume& volume) {
  assemble(topology, silhouette, light_model.w == 0.0, caps, swept_to_infinity(light_model),
           volume);
}

void VolumeBuilder::extrude_by(const Topology& topology, const Silhouette& silhouette,
                               const glm::dvec4& light_model, double amount, Caps caps,
                               ShadowVolume& volume) {
  assemble(topology, silhouette, false, caps, swept_by(light_model, amount), volume);
}

void VolumeBuilder::extrude_by_radius(const Topology& topology, const Silhouette& silhouette,
                                      const glm::dvec4& light_model,
                                      const glm::mat4& world_from_model, double radius_m, Caps caps,
                                      ShadowVolume& volume) {
  raster::require(radius_m > 0.0, "a radius is positive and finite");
  // A direction's unit is a metre already (light_in_model).
  if (light_model.w == 0.0) {
    extrude_by(topology, silhouette, light_model, radius_m, caps, volume);
    return;
  }
  assemble(topology, silhouette, false, caps,
           swept_by_radius(light_model, world_from_model, radius_m), volume);
}

ShadowVolume extrude_to_infinity(const Topology& topology, const Silhouette& silhouette,
                                 const glm::dvec4& light_model, Caps caps) {
  ShadowVolume volume;
  VolumeBuilder().extrude_to_infinity(topology, silhouette, light_model, caps, volume);
  return volume;
}

ShadowVolume extrude_by(const Topology& topology, const Silhouette& silhouette,
                        const glm::dvec4& light_model, double amount, Caps caps) {
  ShadowVolume volume;
  VolumeBuilder().extrude_by(topology, silhouette, light_model, amount, caps, volume);
  return volume;
}

ShadowVolume extrude_by_radius(const Topology& topology, const Silhouette& silhouette,
                               const glm::dvec4& light_model, const glm::mat4& world_from_model,
                               double radius_m, Caps caps) {
  ShadowVolume volume;
  VolumeBuilder().extrude_by_radius(topology, silhouette, light_model, world_from_model, radius_m,
                                    caps, volume);
  return volume;
}

}  // namespace gnomon::pipeline
