// A capture's model as a scene of one object for each part, named as its node.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/scene.h"

namespace gnomon::ar {

struct CaptureModel {
  pipeline::Scene scene;
  /// Of each object: its material's base colour as diffuse reflectance, linear.
  std::vector<glm::vec3> reflectance;
  std::vector<std::string> notes;
};

/// Reads a glTF file without the nodes named in `leave_out`. Throws InputError: what read_gltf
/// throws; a name to leave out that no part has; nothing left.
CaptureModel read_capture_model(const std::filesystem::path& file,
                                const std::vector<std::string>& leave_out);

}  // namespace gnomon::ar
