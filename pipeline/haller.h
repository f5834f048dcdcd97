// Shadows in augmented reality with shadow volumes (Haller, Drab, Hartmann 2003, section 3.2.2 and
// appendix A): a photograph of real objects, whose stand-ins are phantoms, and virtual objects.
// Invariant: colour changes only where a virtual object is visible or where the visible point of a
// phantom lies in a virtual object's shadow; every other pixel keeps the photograph's bytes.
// docs/haller.md says where text and appendix disagree and what is done here.
#pragma once

#include "pipeline/count_volumes.h"
#include "pipeline/scene.h"
#include "pipeline/topology.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

struct HallerOptions {
  VolumeMethod method = VolumeMethod::automatic;
  Extrusion extrusion;
  /// As VolumeOptions::all_caps.
  bool all_caps = false;
  /// With at_receivers the picture is the same and the stencil may differ. Saturating counts
  /// (appendix_letter) depend on what else is counted: they are always taken everywhere.
  Counts counts = Counts::everywhere;
  /// The paper to the letter: virtual shadows darken real surfaces also where the photograph shows
  /// them in a real object's shadow already.
  bool double_shadows = false;
  /// Appendix A's culled single-sided draws with saturating operations.
  bool appendix_letter = false;
  /// RGBA8 of the targets' size, or null. Receives 255 or 0: r where a virtual shadow darkens a
  /// visible real surface, g where a real object's shadow takes the light from a visible virtual
  /// object that no virtual object shades already, b where a virtual object is visible (a: those of
  /// b that receive shadows). The picture stays the same.
  raster::ColorBuffer* masks = nullptr;
  /// Topologies kept between frames; null builds them anew.
  TopologyCache* topologies = nullptr;
  /// Memory of volumes kept between frames; null allocates it anew.
  VolumeMemory* volumes = nullptr;
  /// Threads that make volumes, as in raster::ExecuteOptions.
  int threads = 0;
};

/// Labels of the passes, in the paper's words. With several lights ": LIGHT" follows where a pass
/// is one light's.
namespace haller_label {
inline constexpr const char* kReal = "step 1: real scene with the shadows of real objects";
inline constexpr const char* kPhantoms = "step 2: phantoms into the Z-buffer";
inline constexpr const char* kRealVolumes =
    "step 2: volumes of real objects, whose shadow the photograph has";
inline constexpr const char* kVirtualVolumes =
    "step 2: volumes of virtual objects into the stencil buffer";
inline constexpr const char* kShadowOnReal = "step 2: virtual shadow on real objects";
inline constexpr const char* kVirtualLit = "step 3: virtual objects lit";
inline constexpr const char* kAllVolumes = "step 3: volumes of real and virtual objects";
inline constexpr const char* kShadowOnVirtual = "step 3: shadow on virtual objects";
inline constexpr const char* kMaskClear = "mask: cleared";
inline constexpr const char* kMaskShadowOnReal = "mask: virtual shadow on real objects";
inline constexpr const char* kMaskVirtual = "mask: virtual objects";
inline constexpr const char* kMaskVirtualVolumes = "mask: volumes of virtual objects";
inline constexpr const char* kMaskRealVolumes = "mask: volumes of real objects";
inline constexpr const char* kMaskShadowOnVirtual = "mask: shadow of real on virtual objects";
}  // namespace haller_label

/// Records the frame. Lights with samples count as so many lights (light_samples.h); with RGBA8
/// each light's part is rounded to 1/255, so many samples want an RGBA32F target.
/// Preconditions: all three targets, of the photograph's size; `scene`, the photograph's pixels and
/// the buffers outlive the execution of the frame.
/// After execution: colour r, g, b is the augmented photograph, alpha 1 where a virtual object is
/// visible and 0 elsewhere; depth is that of phantoms and virtual objects together.
raster::Frame record_haller(const Scene& scene, const Camera& camera,
                            const raster::ImageView& photograph, const raster::Targets& targets,
                            const HallerOptions& options = {});

}  // namespace gnomon::pipeline
