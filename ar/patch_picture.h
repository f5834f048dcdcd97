// A lit scene's patches as a camera sees them, to look at what a capture found.
#pragma once

#include <glm/mat4x4.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "pipeline/lit_scene.h"

namespace gnomon::ar {

/// One flat colour a patch: its radiance through the tone curve; black beside the model and on back
/// sides. Of the camera's size, its lens included; `world_from_camera` in OpenCV's axes.
Image patch_picture(const pipeline::LitScene& scene, const CameraModel& camera,
                    const glm::dmat4& world_from_camera, int threads);

}  // namespace gnomon::ar
