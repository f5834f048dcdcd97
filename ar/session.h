// A scene at work: pictures come in one after another, tags place camera and bodies, and the method
// draws.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "ar/augment.h"
#include "ar/differential_augment.h"
#include "ar/image.h"
#include "ar/scene_file.h"
#include "ar/tracker.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

struct SessionOptions {
  /// Instead of the scene file's own; volumes also where that has a [differential] table.
  std::optional<pipeline::VolumeMethod> method;
  /// Shadows from the real scene's light, and what differs from the scene file's table; the file
  /// is needed where there is no such table.
  bool differential = false;
  std::filesystem::path lit_scene;
  std::optional<std::size_t> passes;
  std::optional<double> budget_ms;
  /// The one picture of a camera that does not move.
  bool still = false;
  bool double_shadows = false;
  /// As in AugmentOptions; samples 0 is the scene file's.
  int samples = 0, threads = 0;
  bool masks = true, steps = false, frame = false;
  /// Poses as measured, whatever the scene file says.
  bool no_filter = false;
};

/// One picture's outcome.
struct SessionResult {
  TrackResult track;
  /// OpenCV's axes; tracked, or the scene file's own. Absent when it is not known.
  std::optional<glm::dmat4> world_from_camera;
  /// Objects at their places in this picture; those whose body was not seen are in `left_out`.
  pipeline::Scene scene;
  std::vector<std::string> left_out;
  /// Absent when nothing could be placed: the photograph stays as it is.
  std::optional<Augmented> augmented;
  double track_ms = 0.0;
  /// Of differential shadows.
  std::optional<DifferentialReport> differential;
};

class Session {
 public:
  /// For pictures of this size. Reads camera, models and dictionaries.
  /// Errors: InputError of any of these, and when the scene's camera does not fit the size.
  Session(const SceneFile& file, int width, int height, const SessionOptions& options);
  ~Session();
  Session(Session&&) noexcept;

  /// Times are seconds and grow. Without `draw` the picture is only tracked, which the filter of
  /// later pictures needs. Precondition: three channels, the session's size.
  SessionResult process(const Image& picture, double time_s, bool draw = true);

  /// As SessionOptions::steps, from the next picture on.
  void keep_steps(bool keep);

  /// What the model reader left out, one sentence each.
  const std::vector<std::string>& notes() const;
  /// The ids that the scene knows, for messages.
  std::string known_tags() const;
  /// The view that pictures are drawn in; of differential shadows once one was.
  const PinholeView& view() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::ar
