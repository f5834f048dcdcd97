// The masks of an augmented photograph by rays: one through each pixel's centre of the photograph's
// own lens. An oracle that knows nothing of views, volumes and buffers.
#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "pipeline/ray_reference.h"
#include "pipeline/scene.h"

namespace gnomon::apps::study {

/// As in ar::Augmented, one channel, 255 or 0.
struct RayMasks {
  ar::Image shadow, shadow_on_virtual, object;
};

/// One a pixel, rows from the top; where the lens images nothing, a ray that meets nothing.
/// `world_from_camera` has OpenCV's axes. Precondition: the camera has a size.
std::vector<pipeline::Ray> lens_rays(const ar::Lens& lens, const glm::dmat4& world_from_camera);

/// Of the scene's first light, as a point. Threads: 0, as many as the machine has.
RayMasks ray_masks(const pipeline::Scene& scene, const ar::Lens& lens,
                   const glm::dmat4& world_from_camera, int threads = 0);

}  // namespace gnomon::apps::study
