// Which patches count as sources of light, and what each gives to each receiver (Gibson 2003,
// sections 4 and 5).
// Invariant: sources are sorted by falling radiance; sums over them are made in that order, so
// every number is the same for any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/lit_scene.h"

namespace gnomon::pipeline {

/// The weight of a colour where one number is needed: Rec. 709 luminance.
inline double luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

/// The distant patches, and of the others the brightest, sorted by falling luminance of radiance
/// (then by number), that together give `power_share` of their power (radiance times area); of
/// these at least one where any has radiance, none otherwise. Misuse: a share not in [0, 1].
std::vector<std::uint32_t> find_sources(const LitScene& scene, double power_share);

/// One row a source, one column a vertex of the model: the radiance that the vertex reflects of the
/// source's light, with everything in place but virtual objects.
struct Transfers {
  std::vector<std::uint32_t> sources;
  std::size_t vertices = 0;
  std::vector<glm::vec3> radiance;

  std::span<const glm::vec3> row(std::size_t source) const {
    return std::span(radiance).subspan(source * vertices, vertices);
  }
};

struct TransferOptions {
  double power_share = 0.8;
  /// Rays a pair of source and vertex: 1, 4 or 16.
  int samples = 4;
  /// As in raster::ExecuteOptions.
  int threads = 0;
};

/// reflectance * radiance * form factor * visible share. Errors: as PatchVisibility.
Transfers compute_transfers(const LitScene& scene, const TransferOptions& options);

}  // namespace gnomon::pipeline
