// The shadow volumes of a scene's casters for one light, made and placed (Haller 2003, section
// 3.1.2; depth fail after Everitt and Kilgard 2002).
// Invariant: whatever is left out of a volume, no count depends on it (make_volumes.cpp has the
// proofs); the volumes are the same for every number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/casters.h"
#include "pipeline/degenerate_quads.h"
#include "pipeline/displaced_caster.h"
#include "pipeline/near_clip.h"
#include "pipeline/placed_object.h"
#include "pipeline/receivers.h"
#include "pipeline/shadow_volume.h"
#include "pipeline/volume_window.h"

namespace gnomon::pipeline {

/// How long volumes are.
struct Extrusion {
  /// Far enough for every receiver and no further; to infinity; by the paper's radius.
  enum class Kind : std::uint8_t { automatic, infinite, radius };
  Kind kind = Kind::automatic;
  /// Metres beyond the caster, for `radius`.
  float radius_m = 1.0f;
};

/// One caster's volume of one light, ready to be counted.
struct PlacedVolume {
  std::shared_ptr<const ShadowVolume> volume;
  const Object* caster = nullptr;
  glm::mat4 clip_from_model{1.0f};
  raster::FrontFace front_face = raster::FrontFace::ccw;
  /// zpass or zfail.
  VolumeMethod method = VolumeMethod::zfail;
  /// The front cap coincides with the caster's surface as it is drawn; so where that is in the
  /// depth buffer, z-pass counts nothing of the cap.
  bool cap_is_drawn = true;
  /// What the automatic extrusion took; absent for the others.
  std::optional<Reach> reach;
  /// The counts' scissor; absent: the whole target.
  std::optional<raster::Rect> window;
};

/// Memory that make_volumes uses again, kept between frames: the builders, and the volumes that no
/// frame and nobody else holds any more. Not for use by several threads at once.
class VolumeMemory {
 public:
  struct Worker {
    VolumeBuilder builder;
    Silhouette silhouette;
    CastingMesh casting;
    /// Swept positions.
    std::vector<glm::vec4> far;
    /// One a caster that the worker makes volumes of.
    std::vector<MovedCaster> moved;
  };
  /// One a chunk of work.
  std::span<Worker> workers(std::size_t count);
  /// So many volumes, of any content.
  std::vector<std::shared_ptr<ShadowVolume>> volumes(std::size_t count);
  /// The extended mesh, built the first time.
  std::shared_ptr<const DegenerateQuads> quads(const std::shared_ptr<const Topology>& topology,
                                               bool both_sides);

 private:
  struct Extended {
    std::shared_ptr<const Topology> topology;
    std::shared_ptr<const DegenerateQuads> quads;
  };
  std::vector<Worker> workers_;
  std::vector<std::shared_ptr<ShadowVolume>> volumes_;
  std::vector<Extended> extended_;
};

/// At which pixels the stencil is the plain method's after the counts (closed volumes to infinity,
/// or of Extrusion's length, for all casters).
enum class Counts : std::uint8_t {
  everywhere,
  /// Where a receiver is visible; elsewhere it may be any number. Volumes that cannot hold a
  /// visible receiver are left out, others get a window, and the automatic extrusion goes to
  /// infinity: within a window, sides are cheaper than the back cap that a finite volume needs.
  at_receivers
};

/// How volumes get their triangles.
enum class VolumeGeometry : std::uint8_t {
  /// Outline and caps are found anew for each light (pipeline/silhouette.h).
  silhouettes,
  /// Vertices of a constant mesh are moved (pipeline/degenerate_quads.h). The counts of volumes to
  /// infinity are those of silhouettes; there is always a cap at both ends. Finite ones of a closed
  /// mesh end where its sides that are turned from the light go, so farther away.
  degenerate_quads
};

struct VolumeOptions {
  VolumeMethod method = VolumeMethod::automatic;
  Extrusion extrusion;
  /// The plain method: every volume has both caps.
  bool all_caps = false;
  /// Volumes as renderers make them that ask for closed manifolds (find_classical_silhouette):
  /// wrong for other meshes. Everything here that is said of counts holds for closed manifolds only
  /// then.
  bool classical = false;
  /// Which objects cast; null: all that Object::casts says.
  const Casters* casters = nullptr;
  /// Of volumes that are not classical.
  VolumeGeometry geometry = VolumeGeometry::silhouettes;
  /// Casters of this role are counted also where they are not in the depth buffer, so their volumes
  /// keep the front cap; so do those of casters that are not what is drawn (Object::shadow_model).
  /// All others must be in it, drawn with surface_state and their PlacedObject.
  std::optional<Role> counted_before_drawn = {};
  Counts counts = Counts::everywhere;
  /// What is drawn, for Counts::at_receivers, whose receivers are those of the objects given;
  /// without it, all volumes are counted everywhere.
  std::optional<View> view = {};
  /// As in raster::ExecuteOptions.
  int threads = 0;
  /// Null: memory of this call's own.
  VolumeMemory* memory = nullptr;
};

/// The scene's receivers where make_volumes needs them: for the automatic extrusion with
/// Counts::everywhere. None otherwise.
Receivers receivers_for(const VolumeOptions& options, const Scene& scene);

/// The volumes of all casters in `objects`, in their order; casters whose volume is empty (nothing
/// faces the light, or no receiver lies behind) are left out. `receivers`: see receivers_for.
/// `light` is taken as a point (or direction): see light_samples.h.
std::vector<PlacedVolume> make_volumes(std::span<const PlacedObject> objects, const Light& light,
                                       const Receivers& receivers,
                                       const std::optional<NearRegion>& region,
                                       const VolumeOptions& options);

}  // namespace gnomon::pipeline
