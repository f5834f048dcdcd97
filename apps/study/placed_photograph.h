// A study's photograph with everything read: pictures, masks, camera, and the scene with all
// objects at their places.
#pragma once

#include <optional>

#include <glm/mat4x4.hpp>

#include "apps/study/study_file.h"
#include "ar/camera.h"
#include "ar/image.h"
#include "ar/scene_file.h"
#include "pipeline/scene.h"

namespace gnomon::apps::study {

struct PlacedPhotograph {
  ar::SceneFile file;
  ar::Lens lens;
  /// Three channels, one size.
  ar::Image photograph, truth;
  std::optional<ar::Image> shadow_mask, object_mask;
  /// OpenCV's axes; tracked, or the scene file's own.
  glm::dmat4 world_from_camera{1.0};
  pipeline::Scene scene;
};

/// Throws ar::InputError of any of its files, when pictures are of different sizes, and when the
/// camera's pose is not found in the photograph.
PlacedPhotograph place(const StudyPhotograph& photograph, int threads);

}  // namespace gnomon::apps::study
