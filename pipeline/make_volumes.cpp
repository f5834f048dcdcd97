// Which caps a count needs. z-fail needs both. z-pass counts faces that pass LESS:
//
// Front cap. It has the bits of the caster's triangles, and is drawn with the same clip_from_model,
// viewport, depth range and depth clamp, clipped or not; neither the order of a triangle's corners
// nor its winding has a say in its fragments (raster/geometry.cpp: a clipped piece's fan starts at
// one and the same vertex). So each of its fragments has the depth of a fragment of the caster's
// surface in the same pixel. Where the caster was drawn with depth LESS and write, and nothing has
// raised the buffer since, the buffer holds at most that: the fragment fails, and the cap counts
// nowhere. This does not hold for a caster that is not in the buffer when its volume is counted
// (Haller's second step counts virtual objects' volumes on phantoms alone), nor for one in whose
// place another mesh is drawn (Object::shadow_model): there the cap stays.
//
// Back cap at infinity. With a far plane, finite or infinite, what is at infinity has a depth that
// is clamped to 1, the largest; nothing in the buffer is larger, so no fragment passes LESS. The
// back cap of a finite volume may lie before a visible surface, and stays: a ray that enters by a
// side and leaves by that cap would be counted as still inside.
#include "pipeline/make_volumes.h"

#include <utility>

#include "pipeline/swept_point.h"
#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// Casters that one piece of work takes.
constexpr std::size_t kChunk = 4;

/// Are volumes made for the pixels of visible receivers alone?
bool makes_windows(const VolumeOptions& options) {
  return options.counts == Counts::at_receivers && options.view &&
         options.extrusion.kind != Extrusion::Kind::radius;
}

bool needs_reach(const VolumeOptions& options) {
  return options.extrusion.kind == Extrusion::Kind::automatic && !makes_windows(options);
}

/// How far a silhouette is swept.
struct Sweep {
  enum class Kind : std::uint8_t { nowhere, infinite, amount, radius };
  Kind kind = Kind::infinite;
  double amount = 0.0;
};

Sweep sweep_of(const Extrusion& extrusion, const std::optional<Reach>& reach) {
  if (extrusion.kind == Extrusion::Kind::radius) {
    return {Sweep::Kind::radius, static_cast<double>(extrusion.radius_m)};
  }
  if (!reach) return {Sweep::Kind::infinite};
  if (reach->kind == Reach::Kind::none) return {Sweep::Kind::nowhere};
  if (reach->kind == Reach::Kind::unbounded) return {Sweep::Kind::infinite};
  return {Sweep::Kind::amount, reach->amount};
}

Caps caps_for(const PlacedObject& object, VolumeMethod method, const Sweep& sweep,
              const VolumeOptions& options) {
  if (options.all_caps || method != VolumeMethod::zpass) return {};
  return {.front = object.object->role == options.counted_before_drawn ||
                   !object.object->casts_as_drawn(),
          .back = sweep.kind != Sweep::Kind::infinite};
}

class Maker {
 public:
  Maker(std::span<const PlacedObject> objects, const Light& light, const Receivers& receivers,
        const std::optional<NearRegion>& region, const VolumeOptions& options)
      : light_(light), receivers_(receivers), region_(region), options_(options) {
    if (makes_windows(options)) in_view_.emplace(objects, *options.view);
  }

  /// Fills `placed` and `volume`; leaves `placed.volume` null where there is none. `quads` is null
  /// for silhouettes.
  void make(const PlacedObject& object, const DegenerateQuads* quads, VolumeMemory::Worker& worker,
            MovedCaster& moved, std::shared_ptr<ShadowVolume> volume, PlacedVolume& placed) const {
    const Topology& topology = caster_for(object, light_.position, moved);
    const glm::mat4& world_from_model = object.object->world_from_model;
    const glm::dvec4 light_model = light_in_model(light_.position, world_from_model);
    placed.method =
        choose_method(options_.method, region_, light_.position, topology, world_from_model);
    if (in_view_ && !find_window(topology, world_from_model, placed)) return;
    Silhouette& silhouette = worker.silhouette;
    if (quads)
      find_casting(topology, light_model, quads->both_sides, silhouette.casting);
    else if (options_.classical)
      find_classical_silhouette(topology, light_model, silhouette);
    else
      find_silhouette(topology, light_model, silhouette);
    if (needs_reach(options_)) {
      worker.casting.assign(topology, silhouette.casting, world_from_model);
      placed.reach = find_reach(light_.position, worker.casting, receivers_);
    }
    const Sweep sweep = sweep_of(options_.extrusion, placed.reach);
    if (sweep.kind == Sweep::Kind::nowhere) return;
    if (quads) {
      sweep_quads(*quads, topology, world_from_model, light_model, sweep, worker, *volume);
    } else {
      const Caps caps = caps_for(object, placed.method, sweep, options_);
      extrude(topology, world_from_model, light_model, sweep, caps, worker, *volume);
    }
    if (volume->empty()) return;
    placed.volume = std::move(volume);
    placed.caster = object.object;
    placed.clip_from_model = object.clip_from_model;
    placed.front_face = object.front_face;
    placed.cap_is_drawn = object.object->casts_as_drawn();
  }

 private:
  /// False: the volume is not needed.
  bool find_window(const Topology& topology, const glm::mat4& world_from_model,
                   PlacedVolume& placed) const {
    // Depth pass with the eye in a volume counts wrongly, and everywhere; so does the plain method.
    const bool sound =
        placed.method != VolumeMethod::zpass || options_.method == VolumeMethod::automatic ||
        (region_ && !volume_may_touch(*region_, light_.position, topology, world_from_model));
    if (!sound) return true;
    const raster::Rect window = in_view_->window_of(light_.position, topology, world_from_model);
    if (window.width == 0) return false;
    const View& view = *options_.view;
    if (window != raster::Rect{0, 0, view.width, view.height}) placed.window = window;
    return true;
  }

  static void extrude(const Topology& topology, const glm::mat4& world_from_model,
                      const glm::dvec4& light_model, const Sweep& sweep, Caps caps,
                      VolumeMemory::Worker& worker, ShadowVolume& volume) {
    const Silhouette& silhouette = worker.silhouette;
    switch (sweep.kind) {
      case Sweep::Kind::radius:
        worker.builder.extrude_by_radius(topology, silhouette, light_model, world_from_model,
                                         sweep.amount, caps, volume);
        break;
      case Sweep::Kind::amount:
        worker.builder.extrude_by(topology, silhouette, light_model, sweep.amount, caps, volume);
        break;
      default:
        worker.builder.extrude_to_infinity(topology, silhouette, light_model, caps, volume);
        break;
    }
  }

  static void sweep_quads(const DegenerateQuads& quads, const Topology& topology,
                          const glm::mat4& world_from_model, const glm::dvec4& light_model,
                          const Sweep& sweep, VolumeMemory::Worker& worker, ShadowVolume& volume) {
    const auto to = [&](const auto& far_of) {
      displace(quads, topology, worker.silhouette.casting, far_of, worker.far, volume);
    };
    if (sweep.kind == Sweep::Kind::infinite)
      to(swept_to_infinity(light_model));
    else if (sweep.kind == Sweep::Kind::amount || light_model.w == 0.0)
      to(swept_by(light_model, sweep.amount));
    else
      to(swept_by_radius(light_model, world_from_model, sweep.amount));
  }

  const Light& light_;
  const Receivers& receivers_;
  const std::optional<NearRegion>& region_;
  const VolumeOptions& options_;
  std::optional<ReceiversInView> in_view_;
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

std::shared_ptr<const DegenerateQuads> VolumeMemory::quads(
    const std::shared_ptr<const Topology>& topology, bool both_sides) {
  for (const Extended& known : extended_) {
    if (known.topology == topology && known.quads->both_sides == both_sides) return known.quads;
  }
  // Topologies that nobody else holds do not come again.
  std::erase_if(extended_, [](const Extended& known) { return known.topology.use_count() == 1; });
  extended_.push_back({topology, std::make_shared<const DegenerateQuads>(
                                     add_degenerate_quads(*topology, both_sides))});
  return extended_.back().quads;
}

Receivers receivers_for(const VolumeOptions& options, const Scene& scene) {
  return needs_reach(options) ? Receivers(scene) : Receivers();
}

std::vector<PlacedVolume> make_volumes(std::span<const PlacedObject> objects, const Light& light,
                                       const Receivers& receivers,
                                       const std::optional<NearRegion>& region,
                                       const VolumeOptions& options) {
  std::vector<const PlacedObject*> casters;
  for (const PlacedObject& object : objects) {
    const bool casts =
        options.casters ? options.casters->contains(*object.object) : object.object->casts;
    if (casts) casters.push_back(&object);
  }
  VolumeMemory own_memory;
  VolumeMemory& memory = options.memory ? *options.memory : own_memory;
  auto volumes = memory.volumes(casters.size());
  const std::span<VolumeMemory::Worker> workers =
      memory.workers((casters.size() + kChunk - 1) / kChunk);
  std::vector<PlacedVolume> placed(casters.size());
  const bool extends = options.geometry == VolumeGeometry::degenerate_quads;
  raster::require(!extends || !options.classical, "classical volumes have silhouettes");
  std::vector<std::shared_ptr<const DegenerateQuads>> quads(casters.size());
  for (std::size_t i = 0; extends && i < casters.size(); ++i) {
    const glm::dvec4 light_model =
        light_in_model(light.position, casters[i]->object->world_from_model);
    // What moves keeps its triangles, so these serve it too.
    const std::shared_ptr<const Topology>& topology = casters[i]->caster_topology;
    quads[i] = memory.quads(topology, casts_both_sides(*topology, light_model));
  }
  const Maker maker(objects, light, receivers, region, options);
  raster::for_each_chunk(casters.size(), kChunk, options.threads,
                         [&](std::size_t first, std::size_t last) {
                           VolumeMemory::Worker& worker = workers[first / kChunk];
                           worker.moved.resize(kChunk);
                           for (std::size_t i = first; i < last; ++i) {
                             maker.make(*casters[i], quads[i].get(), worker,
                                        worker.moved[i - first], std::move(volumes[i]), placed[i]);
                           }
                         });
  std::erase_if(placed, [](const PlacedVolume& volume) { return volume.volume == nullptr; });
  return placed;
}

}  // namespace gnomon::pipeline
