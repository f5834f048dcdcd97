// Soft shadows of virtual objects on a photograph: for each source of real light that they hide a
// hard shadow, whose share of the light is subtracted from the picture (Gibson 2003, section 7;
// differential rendering after Debevec 1998).
// Invariant: a pixel changes only where a virtual object is visible or where a receiver's visible
// point lies in some source's shadow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/count_volumes.h"
#include "pipeline/differential_shadows.h"
#include "pipeline/light_paths.h"
#include "pipeline/lit_scene.h"
#include "pipeline/object_light.h"
#include "pipeline/object_takes.h"
#include "pipeline/patch_light.h"
#include "pipeline/scene.h"
#include "pipeline/shadow_map.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// How a source's shadow is found.
enum class ShadowMask : std::uint8_t {
  /// A depth map of the casters, looked up with one comparison (the paper).
  map,
  /// The casters' shadow volume, counted in the stencil buffer: no texel, no offset, and of the two
  /// the faster one (docs/gibson.md).
  volumes
};

struct DifferentialOptions {
  ShadowTakeOptions take;
  ShadowMask mask = ShadowMask::volumes;
  int map_size = 256;
  /// Shadows of virtual objects on virtual objects.
  bool self_shadows = true;
};

namespace differential_label {
inline constexpr const char* kBackground = "background image";
inline constexpr const char* kWhite = "white, which shares are taken of";
inline constexpr const char* kModel = "scene model into the depth buffer";
inline constexpr const char* kObjects = "synthetic objects";
inline constexpr const char* kVolumes = "shadow volumes: source ";
inline constexpr const char* kSubtract = "subtract source ";
}  // namespace differential_label

/// Keeps what does not change between frames, and memory of what does. Refers to scene and paths.
class DifferentialMethod {
 public:
  DifferentialMethod(const LitScene& scene, const LightPaths& paths);
  ObjectLight& object_light() { return object_light_; }

  /// Records one frame. Objects of `virtual_scene` are virtual; its lights are not used.
  /// Targets have the photograph's size: colour (RGBA8 for bytes and dithered, RGBA32F otherwise),
  /// depth, and stencil for volumes. After execution colour is what PictureFinish takes: of a
  /// visible virtual object its value over 255, or radiance; elsewhere
  /// - by share: what is left of the photograph's radiance, as a part of it (bytes, dithered,
  ///   values), or that less 1 (radiance);
  /// - else the photograph's value less what shadows take, over 255 (bytes, dithered, values), or
  ///   the radiance that they take, 0 or less (radiance);
  /// alpha is 1 where a virtual object is visible and 0 elsewhere.
  /// The frame borrows from this object: it is good until the next one is recorded.
  /// Preconditions: photograph and targets outlive the execution; the photograph is only looked at
  /// where values are not taken by share, and has the targets' size there.
  raster::Frame record(const Scene& virtual_scene, const Camera& camera,
                       const raster::ImageView& photograph, const raster::Targets& targets,
                       const DifferentialOptions& options);

  /// Of the last frame.
  const DifferentialShadows& shadows() const { return shadows_; }
  /// Of the last frame, what finding sources and receivers took (section 6.1), in milliseconds.
  double traverse_ms() const { return traverse_ms_; }

 private:
  /// One an object, part and vertex.
  using ObjectColors = std::vector<std::vector<std::vector<glm::vec4>>>;

  void record_surfaces(raster::Frame& frame, const Camera& camera,
                       const raster::ImageView& photograph, const raster::Targets& targets,
                       const DifferentialOptions& options);
  raster::DepthLookup record_map(raster::Frame& frame, std::size_t number,
                                 const Scene& virtual_scene, int size);
  void count(raster::Frame& frame, std::size_t number, const Camera& camera,
             const raster::Targets& targets, const DifferentialOptions& options);
  void subtract(raster::Frame& frame, std::size_t number, const Camera& camera,
                const raster::Targets& targets, const std::optional<raster::DepthLookup>& map);
  void color_objects(const ObjectRadiance& radiance, const DifferentialOptions& options);

  const LitScene& scene_;
  const LightPaths& paths_;
  PatchVisibility visibility_;
  ObjectLight object_light_;
  std::vector<glm::vec4> model_positions_;
  std::vector<std::uint32_t> model_indices_;
  OccludedLight occluded_;
  double traverse_ms_ = 0.0;
  DifferentialShadows shadows_;
  TopologyCache topologies_;
  MapMemory maps_;
  VolumeMemory volumes_;
  std::vector<PlacedObject> placed_;
  ObjectColors drawn_;
  /// Empty without self-shadows.
  ObjectTakes taken_;
};

}  // namespace gnomon::pipeline
