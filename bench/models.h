// Scenes made of model files: the desk, and several meshes at once.
#pragma once

#include <filesystem>
#include <span>

#include "pipeline/scene.h"

namespace gnomon::bench {

struct World {
  pipeline::Scene scene;
  pipeline::Camera camera;
};

/// The desk of the capture with a virtual torus and sphere, as one scene: phantoms are drawn, the
/// first light shines. Its camera sees the whole photograph at any size, without the lens.
/// Textures are left out, so that every system shades the same. Throws ar::InputError.
World desk_world(int width, int height);

/// The repository's own small models and `more`, each brought to one size and set up where the tori
/// stand. Throws ar::InputError.
pipeline::Scene meshes_scene(std::span<const std::filesystem::path> more);

}  // namespace gnomon::bench
