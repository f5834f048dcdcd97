// A box for scenes.
#pragma once

#include "pipeline/scene.h"

namespace gnomon::golden {

/// About the origin, four vertices a face with its normal and texture coordinates from -1.5 to 1.5.
pipeline::Mesh box(const glm::vec3& half);

}  // namespace gnomon::golden
