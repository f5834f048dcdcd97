#include "apps/inspector/lab_stage.h"

#include <memory>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>

#include "apps/inspector/turn.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::inspector {

namespace {

using pipeline::Mesh;
using pipeline::Model;

constexpr glm::vec3 kTarget{0.0f, 0.6f, 0.0f};

std::shared_ptr<const Model> model(Mesh mesh, const glm::vec3& color, bool two_sided = false) {
  pipeline::Part part;
  part.mesh = std::move(mesh);
  part.material.ambient = 0.35f * color;
  part.material.diffuse = 0.65f * color;
  part.two_sided = two_sided;
  Model out;
  out.parts.push_back(std::move(part));
  return std::make_shared<const Model>(std::move(out));
}

/// A box whose upper side is missing.
Mesh open_box_mesh(float half) {
  Mesh mesh = pipeline::flat_box_mesh(glm::vec3(half));
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    if (mesh.normals[mesh.indices[i]].y < 0.5f)
      kept.insert(kept.end(), mesh.indices.begin() + static_cast<std::ptrdiff_t>(i),
                  mesh.indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
  mesh.indices = kept;
  return mesh;
}

/// From the object's own place to the world: a turn about y, then the move.
glm::mat4 placed(const LabState& state, const glm::vec3& at) {
  const Turn turn = turn_of_degrees(state.object_turn_deg);
  const auto c = static_cast<float>(turn.cosine), s = static_cast<float>(turn.sine);
  glm::mat4 out(1.0f);
  out[0] = {c, 0.0f, -s, 0.0f};
  out[2] = {s, 0.0f, c, 0.0f};
  out[3] = glm::vec4(
      at + glm::vec3(static_cast<float>(state.object_x_m), static_cast<float>(state.object_y_m),
                     static_cast<float>(state.object_z_m)),
      1.0f);
  return out;
}

pipeline::Object object(std::string name, std::shared_ptr<const Model> shape,
                        const glm::mat4& world_from_model) {
  pipeline::Object out;
  out.name = std::move(name);
  out.model = std::move(shape);
  out.world_from_model = world_from_model;
  return out;
}

/// Thin plates one above the other, each a little smaller than the one below, so that all of their
/// volumes hold the floor's middle.
void add_plates(const LabState& state, pipeline::Scene& scene) {
  const auto shape = model(pipeline::flat_box_mesh({0.6f, 0.0008f, 0.6f}), {0.85f, 0.55f, 0.25f});
  for (int i = 0; i < state.plates; ++i) {
    const auto number = static_cast<float>(i);
    const float height = 0.5f + 0.0025f * number, size = 1.0f - 0.001f * number;
    glm::mat4 at = placed(state, {0.0f, height, 0.0f});
    at[0] *= size;
    at[2] *= size;
    scene.objects.push_back(object("plate " + std::to_string(i + 1), shape, at));
  }
}

}  // namespace

pipeline::Scene lab_scene(const LabState& state) {
  pipeline::Scene scene;
  scene.ambient = glm::vec3(1.0f);
  glm::mat4 floor_place(1.0f);
  // A map shows what casts, so the floor of the stage about maps is as small as one map can see.
  const bool floor_casts = state.stage == LabStage::acne;
  pipeline::Mesh floor = pipeline::square_mesh(floor_casts ? 2.2f : 6.0f);
  scene.objects.push_back(
      object("floor", model(std::move(floor), {0.72f, 0.74f, 0.78f}, true), floor_place));
  scene.objects.back().casts = floor_casts;
  switch (state.stage) {
    case LabStage::camera_in_shadow:
      scene.objects.push_back(
          object("box", model(pipeline::flat_box_mesh({0.7f, 0.5f, 0.7f}), {0.85f, 0.45f, 0.25f}),
                 placed(state, {0.0f, 1.4f, 0.0f})));
      scene.objects.push_back(object("ball",
                                     model(pipeline::icosphere_mesh(0.3f, 3), {0.3f, 0.5f, 0.8f}),
                                     placed(state, {-1.3f, 0.5f, -0.6f})));
      break;
    case LabStage::missing_cap:
      scene.objects.push_back(object("ball",
                                     model(pipeline::icosphere_mesh(0.4f, 3), {0.3f, 0.5f, 0.8f}),
                                     placed(state, {0.0f, 1.7f, 0.0f})));
      break;
    case LabStage::overflow:
      add_plates(state, scene);
      break;
    case LabStage::open_mesh:
      scene.objects.push_back(object("open box",
                                     model(open_box_mesh(0.5f), {0.35f, 0.65f, 0.4f}, true),
                                     placed(state, {0.0f, 0.9f, 0.0f})));
      break;
    case LabStage::acne:
      scene.objects.push_back(
          object("box", model(pipeline::flat_box_mesh({0.4f, 0.6f, 0.4f}), {0.85f, 0.45f, 0.25f}),
                 placed(state, {0.7f, 0.6f, -0.3f})));
      scene.objects.push_back(object("ball",
                                     model(pipeline::icosphere_mesh(0.5f, 3), {0.3f, 0.5f, 0.8f}),
                                     placed(state, {-0.6f, 0.5f, 0.3f})));
      break;
  }
  pipeline::Light lamp;
  lamp.name = "lamp";
  lamp.position = {static_cast<float>(state.light_x_m), static_cast<float>(state.light_y_m),
                   static_cast<float>(state.light_z_m), 1.0f};
  lamp.color = glm::vec3(1.0f);
  lamp.shadow = state.method == LabMethod::shadow_map ? pipeline::ShadowMethod::map
                                                      : pipeline::ShadowMethod::volumes;
  lamp.map.sides = pipeline::MapSides::one;
  lamp.map.size = state.map_size;
  lamp.map.offset = raster::PolygonOffset{static_cast<float>(state.map_offset_factor),
                                          static_cast<float>(state.map_offset_units)};
  lamp.map.filter = state.map_filtered ? raster::Filter::linear : raster::Filter::nearest;
  scene.lights.push_back(lamp);
  return scene;
}

pipeline::Camera lab_camera(const LabState& state) {
  const Turn turn = turn_of_degrees(state.camera_turn_deg),
             tilt = turn_of_degrees(state.camera_tilt_deg);
  const glm::vec3 direction(static_cast<float>(turn.sine * tilt.cosine),
                            static_cast<float>(tilt.sine),
                            static_cast<float>(turn.cosine * tilt.cosine));
  pipeline::Camera camera;
  camera.width = state.width;
  camera.height = state.height;
  camera.eye_world = kTarget + static_cast<float>(state.camera_distance_m) * direction;
  // A field of view of 2 atan(0.45) from bottom to top; what glm::perspective makes of it, without
  // the tangent.
  constexpr float kTangent = 0.45f, kNear = 0.05f, kFar = 60.0f;
  const float aspect = static_cast<float>(state.width) / static_cast<float>(state.height);
  glm::mat4 clip_from_camera(0.0f);
  clip_from_camera[0][0] = 1.0f / (aspect * kTangent);
  clip_from_camera[1][1] = 1.0f / kTangent;
  clip_from_camera[2][2] = -(kFar + kNear) / (kFar - kNear);
  clip_from_camera[2][3] = -1.0f;
  clip_from_camera[3][2] = -(2.0f * kFar * kNear) / (kFar - kNear);
  camera.clip_from_world =
      clip_from_camera * glm::lookAt(camera.eye_world, kTarget, {0.0f, 1.0f, 0.0f});
  return camera;
}

}  // namespace gnomon::apps::inspector
