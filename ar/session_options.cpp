#include "ar/session_options.h"

#include <string>

#include "ar/error.h"
#include "ar/shadow_settings.h"

namespace gnomon::ar {

AugmentOptions augment_options(const SceneFile& file, const SessionOptions& options) {
  AugmentOptions out;
  out.method = options.method.value_or(volume_method(file.shadow.method));
  out.extrusion = extrusion(file.shadow.volume);
  out.double_shadows = options.double_shadows || file.shadow.double_shadows;
  out.samples = options.samples != 0 ? options.samples : file.samples;
  out.threads = options.threads;
  out.near_m = file.near_m;
  out.far_m = file.far_m;
  out.masks = options.masks;
  out.steps = options.steps;
  out.frame = options.frame;
  return out;
}

std::optional<DifferentialFile> differential_file(const SceneFile& file,
                                                  const SessionOptions& options) {
  if (options.method || !(options.differential || file.differential)) return std::nullopt;
  DifferentialFile out = file.differential.value_or(DifferentialFile{});
  if (!options.lit_scene.empty()) out.lit_scene = options.lit_scene;
  if (out.lit_scene.empty())
    throw InputError(file.file.string() +
                     ": [differential].lit_scene: missing, and no --lit-scene was given");
  DifferentialSettings& settings = out.settings;
  if (options.passes) {
    settings.method.take.passes = *options.passes;
    settings.budget_ms = 0.0;
  }
  if (options.budget_ms) settings.budget_ms = *options.budget_ms;
  settings.samples = options.samples != 0 ? options.samples : file.samples;
  settings.threads = options.threads;
  settings.near_m = file.near_m;
  settings.far_m = file.far_m;
  settings.masks = options.masks;
  settings.steps = options.steps;
  settings.frame = options.frame;
  return out;
}

CameraModel photograph_camera(const SceneFile& file, int width, int height) {
  require_photograph(file);
  try {
    if (file.pinhole) return camera_for_picture(*file.pinhole, width, height);
    return camera_for_picture(read_camera(file.camera_file), width, height);
  } catch (const InputError& error) {
    const std::string what = error.what();
    const std::string name = (file.pinhole ? file.file : file.camera_file).string();
    if (what.starts_with(name)) throw;
    throw InputError(name + ": " + what);
  }
}

}  // namespace gnomon::ar
