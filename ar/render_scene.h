// A scene file as a picture: no photograph, no tags. Phantoms are drawn like everything else.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ar/image.h"
#include "ar/pass_pictures.h"
#include "ar/scene_file.h"
#include "ar/scene_models.h"
#include "pipeline/near_clip.h"
#include "pipeline/scene.h"
#include "pipeline/shadow_map.h"
#include "pipeline/topology.h"

namespace gnomon::ar {

/// How light is put together: added light by light where no shadow is, or taken away by a dark quad
/// (Kuehl, section 3.2).
enum class RenderMethod { additive, modulative };

struct RenderOptions {
  RenderMethod method = RenderMethod::additive;
  /// Instead of the scene file's own.
  std::optional<pipeline::VolumeMethod> counting;
  /// Pixels; 0: the camera's, or 640x480.
  int width = 0, height = 0;
  /// Also keep the buffers after every pass, the recorded frame's bytes, and what rays say.
  bool steps = false, frame = false, rays = false;
  /// 0: as many as the machine has.
  int threads = 0;
};

/// One light's hard shadows against rays (pipeline/ray_reference.h), at the pixels that it would
/// light.
struct RayCheck {
  std::string light;
  std::size_t tested = 0, in_shadow = 0, too_dark = 0, too_light = 0;
  /// Of the same pixels, those that differ from rays to the models that are drawn: what shadow
  /// models change. Absent where every caster casts as it is drawn.
  std::optional<std::size_t> differ_from_drawn = {};
};

struct Rendered {
  Image picture;
  std::vector<PassPictures> steps;
  std::vector<PassNote> passes;
  /// As encode_frame writes it (docs/frame-format.md). Empty unless asked for.
  std::vector<std::uint8_t> frame;
  std::vector<RayCheck> checks;
  /// Red: too dark, blue: too light, for any light. Empty unless rays were asked for.
  Image wrong;
  /// Objects on bodies, which only tags place.
  std::vector<std::string> left_out;
  std::vector<std::string> notes;
  std::size_t objects = 0, lights = 0, triangles = 0;
  double record_ms = 0.0, execute_ms = 0.0;
};

/// The scene file's camera; without a pose it stands so that it sees everything, from the front and
/// above, and without intrinsics it has 640x480 pixels and a field of view of 40 degrees.
/// Errors: InputError of camera, models and casters, of a size that the camera cannot have, and
/// when no object is in the scene.
Rendered render_scene(const SceneFile& file, const RenderOptions& options);

/// What render_scene draws: the objects at their places, and the camera.
struct PlacedScene {
  pipeline::Scene scene;
  pipeline::Camera camera;
  std::vector<std::string> left_out;
};

/// Width and height as in RenderOptions; models in the order of file.objects. Errors: as
/// render_scene.
PlacedScene place_scene(const SceneFile& file, const std::vector<ObjectModels>& models, int width,
                        int height);

/// What is kept from frame to frame.
struct RenderMemory {
  pipeline::TopologyCache topologies;
  pipeline::MapMemory maps;
};

/// The same with these models, in the order of file.objects, in place of those that it names.
Rendered render_scene(const SceneFile& file, const std::vector<ObjectModels>& models,
                      const RenderOptions& options, RenderMemory& memory);

}  // namespace gnomon::ar
