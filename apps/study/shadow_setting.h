// One way of finding a light's shadow, with everything about it that can be set, and the ways that
// are charted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "pipeline/general_method.h"
#include "pipeline/map_settings.h"
#include "pipeline/scene.h"
#include "raster/buffers.h"

namespace gnomon::apps::study {

struct ShadowSetting {
  /// "z-fail", and what it is charted with ("volumes").
  std::string name, family;
  pipeline::ShadowMethod method = pipeline::ShadowMethod::volumes;
  /// Of volumes.
  pipeline::VolumeMethod counting = pipeline::VolumeMethod::automatic;
  pipeline::Extrusion extrusion = {};
  pipeline::VolumeGeometry geometry = pipeline::VolumeGeometry::silhouettes;
  pipeline::Counts counts = pipeline::Counts::at_receivers;
  bool classical = false, appendix_letter = false, single_sided = false;
  /// Of maps.
  pipeline::MapSettings map = {};
  raster::DepthFormat depth = raster::DepthFormat::d24;
  /// Triangles that an object casts with, at most; 0: all.
  std::size_t occluder_triangles = 0;
};

/// Shadow volumes counted in this way, to infinity or as far as needed.
ShadowSetting volumes(std::string name, pipeline::VolumeMethod counting, bool infinite = true);
/// A map of so many texels a side; 0: found.
ShadowSetting map(std::string name, int size);
ShadowSetting alias_free();

/// All that are charted: each way of counting volumes, lengths, depth formats, maps of each size
/// with hard and filtered lookups, alias-free maps, reduced casters, and no shadow at all.
std::vector<ShadowSetting> charted_settings();

}  // namespace gnomon::apps::study
