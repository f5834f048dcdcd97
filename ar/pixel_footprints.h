// Which patches a photograph's pixels show, each with its share: the link between measured radiance
// and patches, for photographs of any kind (a mirror ball's rays are bent, a camera's are not).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "ar/image_file.h"
#include "ar/mirror_ball.h"
#include "pipeline/patch_light.h"

namespace gnomon::ar {

struct PatchShare {
  std::uint32_t patch = 0;
  float share = 0.0f;
};

/// Pixels with what was measured at them. Pixel i has the shares [first[i], first[i + 1]), which
/// add up to 1. Left out are pixels that see half or more past the model or at back sides.
struct PixelFootprints {
  std::vector<std::size_t> first{0};
  std::vector<PatchShare> shares;
  /// Measured, and the solid angle that stands behind it, in steradians.
  std::vector<glm::dvec3> radiance;
  std::vector<double> solid_angle_sr;
  /// Solid angle over which rays left the model, and over which they met a back side.
  double open_sr = 0.0, back_sr = 0.0, total_sr = 0.0;

  std::size_t size() const { return radiance.size(); }
};

struct FootprintWindow {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct FootprintOptions {
  /// A pixel is cut in samples x samples cells with a ray each.
  int samples = 4;
  int threads = 0;
};

/// The ray behind a place of the picture (pixel centres at integers); absent where there is none to
/// use. Called by several threads at once.
using RayOfPlace = std::function<std::optional<Ray>(glm::dvec2 place)>;

/// Lays the cells of the window's pixels on the patches. A cell counts with its solid angle, and
/// for the four pixels around it with the weights of bilinear interpolation: a picture's pixels see
/// a little over their edges, and a model is never quite where its original is.
/// `radiance` covers the window's pixels.
PixelFootprints find_footprints(const FloatImage& radiance, const FootprintWindow& window,
                                const RayOfPlace& ray_of, const pipeline::PatchVisibility& patches,
                                const pipeline::PatchModel& model,
                                const FootprintOptions& options = {});

}  // namespace gnomon::ar
