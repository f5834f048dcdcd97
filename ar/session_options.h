// What a scene file and a session's options say together, in the methods' own terms.
#pragma once

#include <optional>

#include "ar/augment.h"
#include "ar/camera.h"
#include "ar/scene_file.h"
#include "ar/session.h"

namespace gnomon::ar {

AugmentOptions augment_options(const SceneFile& file, const SessionOptions& options);

/// Absent: shadow volumes. Throws InputError where no lit scene is named.
std::optional<DifferentialFile> differential_file(const SceneFile& file,
                                                  const SessionOptions& options);

/// The scene's camera for photographs of this size. Throws InputError, as Session.
CameraModel photograph_camera(const SceneFile& file, int width, int height);

}  // namespace gnomon::ar
