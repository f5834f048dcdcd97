// Radiance of patches from pixels that show several of them at a time.
#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "ar/pixel_footprints.h"

namespace gnomon::ar {

struct SharedRadiance {
  /// One a patch; 0 where no pixel shows it.
  std::vector<glm::dvec3> radiance;
  /// Solid angle of the pixels' parts that show the patch.
  std::vector<double> solid_angle_sr;
  /// Sum of the pixels' shares.
  std::vector<double> pixels;
};

/// A lamp is often smaller than a few pixels of a mirror ball: the mean over the pixels that touch
/// it loses half its light to the patches around it, whose means gain it. Pixels are therefore
/// shared by what their patches are found to give: from the means on, each patch is multiplied
/// `rounds` times by the mean of measured / explained over its pixels (Richardson 1972, Lucy 1974).
/// Holds after each round: the pixels' explained light adds up to the measured, nothing is
/// negative. 0 rounds: the means weighted by solid angle. Deterministic.
SharedRadiance share_radiance(const PixelFootprints& pixels, std::size_t patches, int rounds);

}  // namespace gnomon::ar
