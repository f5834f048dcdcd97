#include "bench/models.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "ar/camera.h"
#include "ar/gltf.h"
#include "ar/pinhole_view.h"
#include "ar/scene_file.h"
#include "ar/scene_models.h"
#include "bench/tori.h"

namespace gnomon::bench {
namespace {

const std::filesystem::path kSource = GNOMON_SOURCE_DIR;

/// Open and closed, smooth and flat, from 12 to 2,000 triangles.
constexpr const char* kMeshes[] = {
    "examples/desk/virtual/torus.glb",         "examples/desk/virtual/sphere.glb",
    "tests/data/gltf/good/alien_kenney.glb",   "tests/data/gltf/good/no_indices_3storybuilding.glb",
    "tests/data/gltf/good/BoxInterleaved.glb", "examples/photo/stone.glb",
    "examples/desk/phantoms/mug.glb",          "examples/desk/phantoms/house.glb",
    "examples/desk/phantoms/tin.glb"};
/// Edge of the box that each mesh is brought to.
constexpr float kMeshSize_m = 0.7f;

std::shared_ptr<const pipeline::Model> without_textures(pipeline::Model model) {
  for (pipeline::Part& part : model.parts) {
    part.texture = nullptr;
    part.mesh.texcoords.clear();
    part.mesh.colors.clear();
  }
  return std::make_shared<pipeline::Model>(std::move(model));
}

/// The middle of the model's box comes to the origin, its longest edge to kMeshSize_m.
glm::mat4 brought_to_size(const pipeline::Model& model) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
  for (const pipeline::Part& part : model.parts) {
    for (const glm::vec4& position : part.mesh.positions) {
      low = glm::min(low, glm::vec3(position));
      high = glm::max(high, glm::vec3(position));
    }
  }
  const glm::vec3 edges = high - low;
  const float longest = std::max({edges.x, edges.y, edges.z, std::numeric_limits<float>::min()});
  return glm::scale(glm::mat4(1.0f), glm::vec3(kMeshSize_m / longest)) *
         glm::translate(glm::mat4(1.0f), -0.5f * (low + high));
}

}  // namespace

World desk_world(int width, int height) {
  const ar::SceneFile file =
      ar::read_scene(kSource / "tests/data/desk/04_torus_and_sphere_on_tin/true_light.toml");
  World world;
  const auto models = ar::load_models(file);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const ar::SceneObject& object = file.objects[i];
    world.scene.objects.push_back({.name = object.name,
                                   .model = without_textures(*models[i].model),
                                   .world_from_model = glm::mat4(object.body_from_object)});
  }
  world.scene.lights = {file.lights.at(0)};
  world.scene.lights[0].radius = 0.0f;
  world.scene.lights[0].samples = 1;
  world.scene.ambient = file.ambient;

  ar::CameraModel camera = ar::read_camera(file.camera_file);
  const double sx = static_cast<double>(width) / camera.width;
  const double sy = static_cast<double>(height) / camera.height;
  camera = {.width = width,
            .height = height,
            .fx = camera.fx * sx,
            .fy = camera.fy * sy,
            .cx = (camera.cx + 0.5) * sx - 0.5,
            .cy = (camera.cy + 0.5) * sy - 0.5};
  world.camera = ar::PinholeView(ar::Lens(camera), 1)
                     .camera(file.world_from_camera.value(), file.near_m, file.far_m);
  return world;
}

pipeline::Scene meshes_scene(std::span<const std::filesystem::path> more) {
  std::vector<std::filesystem::path> files;
  for (const char* file : kMeshes) files.push_back(kSource / file);
  files.insert(files.end(), more.begin(), more.end());
  pipeline::Scene scene = ground_scene();
  for (std::size_t i = 0; i < files.size(); ++i) {
    auto model = without_textures(ar::read_gltf(files[i]).model);
    const glm::mat4 place = spiral_place(static_cast<int>(i)) * brought_to_size(*model);
    scene.objects.push_back(
        {.name = files[i].stem().string(), .model = std::move(model), .world_from_model = place});
  }
  return scene;
}

}  // namespace gnomon::bench
