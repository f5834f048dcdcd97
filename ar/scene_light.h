// The light of a real scene from its capture: response, radiance, patches, reflectance (Gibson
// 2003, section 3, whole).
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ar/capture_file.h"
#include "pipeline/lit_scene.h"

namespace gnomon::ar {

struct SceneLightOptions {
  /// Instead of the capture file's number of patches; 0: that.
  int patches = 0;
  /// Cells a side that a probe's pixel is cut in, 1 to 16.
  int samples = 4;
  /// Visibility rays for each pair of patches: 1, 4 or 16.
  int visibility_samples = 4;
  /// Rounds of share_radiance.
  int rounds = 20;
  int threads = 0;
  /// Called before each step, with its name and number from 0.
  std::function<void(const char* step, int number)> progress = {};
};

/// How many steps progress is told of.
inline constexpr int kSceneLightSteps = 8;

struct SceneLight {
  pipeline::LitScene scene;
  /// One sentence each: what was left out, filled or is doubtful.
  std::vector<std::string> notes;
  /// How many patches got their radiance from where.
  std::size_t from_photograph = 0, from_probe = 0, filled = 0, emitting = 0;
  /// Median over patches that photograph and probe both see of their radiances' ratio, a channel at
  /// a time; 0 where they see none together.
  glm::dvec3 photograph_over_probe{0.0};
  std::vector<std::pair<std::string, double>> step_ms;
};

/// Does all of it. The unit of radiance is such that, in each channel, the photograph's value 255
/// is just reached at radiance 1. Deterministic for any number of threads. Throws InputError: what
/// the readers of the files throw; pictures whose size is not the camera's; a ball that is not in
/// its picture; a model without triangles or with more than the patches that are possible; a name
/// in leave_out that the model does not have; a probe that says nothing about any patch.
SceneLight find_scene_light(const CaptureFile& capture, const SceneLightOptions& options = {});

}  // namespace gnomon::ar
