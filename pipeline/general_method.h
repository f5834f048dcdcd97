// The general method (Haller 2003, section 3.1.2): an ambient pass, then for each light its shadows
// and a pass that adds the light where there is none. Shadows are counts in the stencil buffer, a
// shadow map or an alias-free one, light by light and object by object (Kuehl, section 5, combined
// usage): each light is added once, where none of them hides it, so no shadow darkens twice.
#pragma once

#include "pipeline/alias_free_map.h"
#include "pipeline/count_volumes.h"
#include "pipeline/scene.h"
#include "pipeline/shadow_map.h"
#include "pipeline/topology.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

struct GeneralOptions {
  VolumeMethod method = VolumeMethod::automatic;
  Extrusion extrusion;
  /// As VolumeOptions::geometry.
  VolumeGeometry geometry = VolumeGeometry::silhouettes;
  /// As VolumeOptions::all_caps.
  bool all_caps = false;
  /// As VolumeOptions::classical: wrong for meshes that are not closed, for comparison.
  bool classical = false;
  /// With at_receivers the picture is the same and the stencil may differ. Saturating counts
  /// (appendix_letter) depend on what else is counted: they are always taken everywhere.
  Counts counts = Counts::everywhere;
  /// Culled single-sided draws and saturating operations (appendix A).
  bool appendix_letter = false;
  /// As CountOptions::single_sided.
  bool single_sided = false;
  glm::vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
  /// Topologies kept between frames; null builds them anew.
  TopologyCache* topologies = nullptr;
  /// Memory of volumes kept between frames; null allocates it anew.
  VolumeMemory* volumes = nullptr;
  /// Depth buffers of lights with a shadow map. Null only if no light has one.
  MapMemory* maps = nullptr;
  /// Memory of alias-free maps kept between frames; null allocates it anew.
  AliasFreeMemory* alias_free = nullptr;
  /// Threads that make volumes and alias-free maps, as in raster::ExecuteOptions.
  int threads = 0;
};

/// Records the frame of a wholly virtual scene: every object, whatever its role, is drawn and
/// shadowed. Labels: "ambient pass", "shadow volumes" and "lit pass", the latter two with ": LIGHT"
/// when there are several lights, "shadow map: LIGHT", "alias-free shadows" in the place of "shadow
/// volumes" where there are no others, and "no volumes" where a light's stencil is only cleared.
/// Where one map cannot serve a point light (plan_shadow_map) it gets six, "shadow map: LIGHT +x"
/// and so on, unless its settings ask for one; then it gets volumes. Preconditions: all three
/// targets; `scene` and the maps outlive the execution of the frame. After execution: colour as
/// described, depth of the scene; the stencil is used up (a pixel that was lit is marked, so that
/// no light adds twice where two surfaces have one depth).
raster::Frame record_general(const Scene& scene, const Camera& camera,
                             const raster::Targets& targets, const GeneralOptions& options = {});

}  // namespace gnomon::pipeline
