// What a shadow method is given: placed objects with a role, lights and a pinhole camera. World:
// right handed, Y up, metres.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/map_settings.h"
#include "pipeline/mesh.h"

namespace gnomon::pipeline {

/// Haller 2003, section 3.2.1: a phantom stands for a real object; it has depth and shadows but no
/// colour.
enum class Role { virtual_object, phantom };

struct Object {
  std::string name;
  Role role = Role::virtual_object;
  std::shared_ptr<const Model> model;
  glm::mat4 world_from_model{1.0f};
  bool casts = true, receives = true;
  /// A mesh in the model's own space that casts in its place (a reduced one); the model is drawn
  /// and receives. Null: the model casts itself.
  std::shared_ptr<const Model> shadow_model = nullptr;
  /// How far, in the model's own space, the shadow model is moved away from the light
  /// (pipeline/displaced_caster.h). At 0 it shadows the model wherever it lies above its surface;
  /// twice its error leaves little of that (docs/kuehl.md). Not negative.
  float shadow_displace = 0.0f;

  /// What casts.
  const std::shared_ptr<const Model>& caster() const { return shadow_model ? shadow_model : model; }
  /// Is what casts what is drawn?
  bool casts_as_drawn() const { return caster() == model; }
};

/// What finds a light's shadows in the general method (pipeline/general_method.h).
enum class ShadowMethod { volumes, map, alias_free, none };

struct Light {
  std::string name;
  /// w = 1: a point in metres; w = 0: the unit direction towards a light at infinity.
  glm::vec4 position{0.0f, 1.0f, 0.0f, 0.0f};
  /// Diffuse and specular colour on virtual objects.
  glm::vec3 color{1.0f};
  /// Part of a real surface's brightness that this light gives; a virtual shadow takes it away (0
  /// to 1).
  float share = 0.5f;
  /// Radius of a spherical (or, at infinity, the angular radius in radians of a disc-shaped) light;
  /// 0 is a point.
  float radius = 0.0f;
  /// Points that stand for a light with a radius; 1 is its centre alone.
  int samples = 1;
  /// Attenuation of a point light with distance (constant, linear, quadratic).
  glm::vec3 attenuation{1.0f, 0.0f, 0.0f};
  /// A spot's beam: a unit vector, and the cosine of the angle to it beyond which nothing is lit;
  /// -1 is no spot. Inside, the light falls off with the cosine to the power of `spot_exponent`. Of
  /// a point light only.
  glm::vec3 spot_direction{0.0f, -1.0f, 0.0f};
  float spot_cos_cutoff = -1.0f;
  int spot_exponent = 0;
  /// How the shadows of all objects are found, unless `shadow_of_object` says it one by one, in the
  /// order of Scene::objects. Methods that know volumes alone take all but `none` as volumes.
  ShadowMethod shadow = ShadowMethod::volumes;
  std::vector<ShadowMethod> shadow_of_object = {};
  MapSettings map = {};
};

struct Scene {
  std::vector<Object> objects;
  std::vector<Light> lights;
  /// Ambient light on virtual objects.
  glm::vec3 ambient{0.3f};
  /// Light objects at their vertices, as OpenGL's fixed function does (raster::Lit::at_vertices),
  /// wherever no shadow map scales a light; where one does, they stay lit pixel by pixel.
  bool vertex_lighting = false;
};

/// A pinhole camera. Clip space is OpenGL's: the near plane is z = -w.
struct Camera {
  glm::mat4 clip_from_world{1.0f};
  glm::vec3 eye_world{0.0f};
  int width = 640, height = 480;
};

}  // namespace gnomon::pipeline
