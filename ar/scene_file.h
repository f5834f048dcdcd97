// The scene as a person writes it: one TOML file that names the camera, the tags, the models, the
// lights and the method's settings. The format, every key with unit and default: docs/scene.md.
// Strict: an unknown key, a wrong type, a value out of range, a duplicate name or a missing file is
// an InputError that names file, line, table, key and value.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "ar/camera.h"
#include "ar/differential_augment.h"
#include "ar/tag_layout.h"
#include "ar/tags.h"
#include "pipeline/map_settings.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

/// What a scene file says it is, and what this reader accepts.
inline constexpr const char* kSceneFormat = "gnomon-scene 1";

/// A place that others hang on.
struct SceneGroup {
  std::string name;
  /// A body, or a group before it; empty for the world.
  std::string attached_to;
  glm::dmat4 parent_from_group{1.0};
};

/// Who casts a light's shadow, and how it is found (pipeline::Shadow).
struct SceneCaster {
  /// An object, a group or a body; empty: everything.
  std::string node;
  /// Empty: every light.
  std::string light;
  pipeline::ShadowMethod method = pipeline::ShadowMethod::volumes;
  pipeline::MapSettings map;
  bool operator==(const SceneCaster&) const = default;
};

struct SceneObject {
  std::string name;
  pipeline::Role role = pipeline::Role::virtual_object;
  std::filesystem::path model;
  /// What casts in the model's place, in its space; empty: the model itself.
  std::filesystem::path shadow_model;
  /// The scene file's line that names it.
  unsigned shadow_model_line = 0;
  /// pipeline::Object::shadow_displace; absent: found.
  std::optional<double> shadow_displace_m;
  /// The body or group that carries it; empty for the world.
  std::string attached_to;
  /// Pose and scale in what carries it. Never mirrors.
  glm::dmat4 body_from_object{1.0};
  bool casts = true, receives = true;
};

enum class ShadowMethod { automatic, zpass, zfail };

/// How far shadow volumes reach: as far as needed, without end, or so many metres from the light.
struct AutomaticReach {
  bool operator==(const AutomaticReach&) const = default;
};
struct InfiniteReach {
  bool operator==(const InfiniteReach&) const = default;
};
using VolumeReach = std::variant<AutomaticReach, InfiniteReach, double>;

struct ShadowSettings {
  ShadowMethod method = ShadowMethod::automatic;
  VolumeReach volume = AutomaticReach{};
  /// Darken also where a phantom's shadow is in the photograph already (the paper to the letter).
  bool double_shadows = false;
};

/// Soft shadows from a real scene's own light: its file (docs/capture.md; empty where the scene
/// file does not say it), and how they are made.
struct DifferentialFile {
  std::filesystem::path lit_scene;
  DifferentialSettings settings;
};

/// The one-euro filter that calms tag jitter; its numbers as in docs/scene.md.
struct FilterSettings {
  bool on = true;
  double min_cutoff_hz = 1.0, beta_per_m = 200.0, beta_per_rad = 40.0, speed_cutoff_hz = 1.0;
};

/// A ROS tags.yaml: its tags' family, and the bundle that is the world (empty: none).
struct TagsYaml {
  std::filesystem::path file;
  std::string family, world;
};

struct SceneFile {
  std::filesystem::path file;

  /// A calibration file, or a camera without one; neither where the scene has no [camera].
  std::filesystem::path camera_file;
  std::optional<CameraModel> pinhole;
  double near_m = 0.02, far_m = 100.0;
  /// A fixed camera in OpenCV's axes (x right, y down, z forward), used instead of tags.
  std::optional<glm::dmat4> world_from_camera;
  /// As AugmentOptions::samples.
  int samples = 0;

  /// Families to look for: those named, or else those that the tags use.
  std::vector<std::string> families;
  std::vector<CustomDictionary> dictionaries;
  /// The camera's response curve, or its gamma, for corners in linear light. At most one of them.
  std::optional<std::filesystem::path> response_file;
  std::optional<double> gamma;
  TagLayout tags;
  std::optional<TagsYaml> tags_yaml;

  std::vector<SceneGroup> groups;
  std::vector<SceneObject> objects;
  /// In the space of what carries them, which is named one by one as in SceneObject.
  std::vector<pipeline::Light> lights;
  std::vector<std::string> light_attached_to;
  /// The files that lights take a node from.
  std::vector<std::filesystem::path> light_models;
  std::vector<SceneCaster> casters;
  glm::vec3 ambient{0.3f};
  /// pipeline::Scene::vertex_lighting.
  bool vertex_lighting = false;
  ShadowSettings shadow;
  /// In place of shadow volumes, where the scene file has them.
  std::optional<DifferentialFile> differential;
  FilterSettings filter;
};

/// Reads a scene file; paths come out joined to its folder, and every file that it names exists.
/// Throws InputError "FILE:LINE: [TABLE 'NAME'].KEY: what is wrong". Reads the models that lights
/// take a node from, no others.
SceneFile read_scene(const std::filesystem::path& path);

/// Throws InputError unless the scene can be put into a photograph: a camera, and tags or a pose.
void require_photograph(const SceneFile& scene);

/// Every file that the scene names, and the scene file itself; not what those name in turn.
std::vector<std::filesystem::path> input_files(const SceneFile& scene);

}  // namespace gnomon::ar
