// Which caps a count needs. z-fail needs both. z-pass counts faces that pass LESS:
//
// Front cap. It has the bits of the caster's triangles, and is drawn with the same clip_from_model,
// viewport, depth range and depth clamp, clipped or not; neither the order of a triangle's corners
// nor its winding has a say in its fragments (raster/geometry.cpp: a clipped piece's fan starts at
// one and the same vertex). So each of its fragments has the depth of a fragment of the caster's
// surface in the same pixel. Where the caster was drawn with depth LESS and write, and nothing has
// raised the buffer since, the buffer holds at most that: the fragment fails, and the cap counts
// nowhere. This does not hold for a caster that is not in the buffer when its volume is counted
// (Haller's second step counts virtual objects' volumes on phantoms alone): there the cap stays.
//
// Back cap at infinity. With a far plane, finite or infinite, what is at infinity has a depth that
// is clamped to 1, the largest; nothing in the buffer is larger, so no fragment passes LESS. The
// back cap of a finite volume may lie before a visible surface, and stays: a ray that enters by a
// side and leaves by that cap would be counted as still inside.
#include "pipeline/make_volumes.h"

#include <utility>

#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// Casters that one piece of work takes.
constexpr std::size_t kChunk = 4;

std::vector<WorldTriangle> casting_triangles(const PlacedObject& object,
                                             const Silhouette& silhouette) {
  const Topology& topology = *object.topology;
  const glm::dmat4 world(object.object->world_from_model);
  std::vector<WorldTriangle> triangles;
  for (std::size_t t = 0; t < silhouette.casting.size(); ++t) {
    if (silhouette.casting[t] == 0) continue;
    WorldTriangle triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      triangle[corner] =
          glm::dvec3(world * glm::dvec4(topology.positions[topology.indices[3 * t + corner]]));
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

/// How far, without an amount: to infinity.
struct Sweep {
  enum class Kind : std::uint8_t { nowhere, infinite, amount, radius };
  Kind kind = Kind::infinite;
  double amount = 0.0;
};

Sweep sweep_of(const Extrusion& extrusion, const std::optional<Reach>& reach) {
  switch (extrusion.kind) {
    case Extrusion::Kind::radius:
      return {Sweep::Kind::radius, static_cast<double>(extrusion.radius_m)};
    case Extrusion::Kind::infinite:
      return {Sweep::Kind::infinite};
    case Extrusion::Kind::automatic:
      break;
  }
  if (reach->kind == Reach::Kind::none) return {Sweep::Kind::nowhere};
  if (reach->kind == Reach::Kind::unbounded) return {Sweep::Kind::infinite};
  return {Sweep::Kind::amount, reach->amount};
}

Caps caps_for(const PlacedObject& object, VolumeMethod method, const Sweep& sweep,
              const VolumeOptions& options) {
  if (options.all_caps || method != VolumeMethod::zpass) return {};
  return {.front = object.object->role == options.counted_before_drawn,
          .back = sweep.kind != Sweep::Kind::infinite};
}

class Maker {
 public:
  Maker(const Light& light, const Receivers& receivers, const std::optional<NearRegion>& region,
        const VolumeOptions& options)
      : light_(light), receivers_(receivers), region_(region), options_(options) {}

  /// Fills `placed` and `volume`; leaves `placed.volume` null where there is none.
  void make(const PlacedObject& object, VolumeMemory::Worker& worker,
            std::shared_ptr<ShadowVolume> volume, PlacedVolume& placed) const {
    const Topology& topology = *object.topology;
    const glm::mat4& world_from_model = object.object->world_from_model;
    const glm::dvec4 light_model = light_in_model(light_.position, world_from_model);
    Silhouette& silhouette = worker.silhouette;
    find_silhouette(topology, light_model, silhouette);
    if (options_.extrusion.kind == Extrusion::Kind::automatic) {
      placed.reach = find_reach(light_.position, casting_triangles(object, silhouette), receivers_);
    }
    const Sweep sweep = sweep_of(options_.extrusion, placed.reach);
    if (sweep.kind == Sweep::Kind::nowhere) return;
    placed.method =
        choose_method(options_.method, region_, light_.position, topology, world_from_model);
    const Caps caps = caps_for(object, placed.method, sweep, options_);
    VolumeBuilder& builder = worker.builder;
    switch (sweep.kind) {
      case Sweep::Kind::radius:
        builder.extrude_by_radius(topology, silhouette, light_model, world_from_model, sweep.amount,
                                  caps, *volume);
        break;
      case Sweep::Kind::amount:
        builder.extrude_by(topology, silhouette, light_model, sweep.amount, caps, *volume);
        break;
      default:
        builder.extrude_to_infinity(topology, silhouette, light_model, caps, *volume);
        break;
    }
    if (volume->empty()) return;
    placed.volume = std::move(volume);
    placed.caster = object.object;
    placed.clip_from_model = object.clip_from_model;
    placed.front_face = object.front_face;
  }

 private:
  const Light& light_;
  const Receivers& receivers_;
  const std::optional<NearRegion>& region_;
  const VolumeOptions& options_;
};

}  // namespace

std::span<VolumeMemory::Worker> VolumeMemory::workers(std::size_t count) {
  if (workers_.size() < count) workers_.resize(count);
  return std::span(workers_).first(count);
}

std::vector<std::shared_ptr<ShadowVolume>> VolumeMemory::volumes(std::size_t count) {
  std::vector<std::shared_ptr<ShadowVolume>> taken;
  taken.reserve(count);
  for (const std::shared_ptr<ShadowVolume>& volume : volumes_) {
    if (taken.size() == count) break;
    if (volume.use_count() == 1) taken.push_back(volume);
  }
  while (taken.size() < count) {
    volumes_.push_back(std::make_shared<ShadowVolume>());
    taken.push_back(volumes_.back());
  }
  return taken;
}

std::vector<PlacedVolume> make_volumes(std::span<const PlacedObject> objects, const Light& light,
                                       const Receivers& receivers,
                                       const std::optional<NearRegion>& region,
                                       const VolumeOptions& options) {
  std::vector<const PlacedObject*> casters;
  for (const PlacedObject& object : objects) {
    if (object.object->casts) casters.push_back(&object);
  }
  VolumeMemory own_memory;
  VolumeMemory& memory = options.memory ? *options.memory : own_memory;
  auto volumes = memory.volumes(casters.size());
  const std::span<VolumeMemory::Worker> workers =
      memory.workers((casters.size() + kChunk - 1) / kChunk);
  std::vector<PlacedVolume> placed(casters.size());
  const Maker maker(light, receivers, region, options);
  raster::for_each_chunk(
      casters.size(), kChunk, options.threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          maker.make(*casters[i], workers[first / kChunk], std::move(volumes[i]), placed[i]);
        }
      });
  std::erase_if(placed, [](const PlacedVolume& volume) { return volume.volume == nullptr; });
  return placed;
}

}  // namespace gnomon::pipeline
