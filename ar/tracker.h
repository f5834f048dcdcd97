// Follows the camera and tagged bodies from picture to picture.
// The camera's pose comes from the world's tags; a body's pose from its own tags, relative to the
// camera, then through the camera to the world. A layout without world tags has the camera at rest
// in the world's origin, looking along -z with y up (OpenGL's axes).
// The filter (pose_filter.h) works on world_from_camera and on each world_from_body; the first
// picture passes it unchanged, so stills are not affected.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "ar/pose.h"
#include "ar/pose_filter.h"
#include "ar/tag_layout.h"
#include "ar/tags.h"

namespace gnomon::ar {

struct TrackerOptions {
  TagDetectorOptions detector;
  std::vector<CustomDictionary> dictionaries;
  PoseOptions pose;
  /// Absent: poses as measured.
  std::optional<OneEuroOptions> filter = OneEuroOptions{};
  /// The camera's filter has these times the betas: held by several tags it is calmer than a body
  /// with a small one, and its lag moves everything in the picture. Figures: docs/tracking.md.
  double camera_beta_gain_per_m = 2.5, camera_beta_gain_per_rad = 10.0;
  /// A pose whose tags are not seen stays for so long.
  double hold_s = 0.25;
};

/// What was found of one body, or of the world.
struct BodyTrack {
  /// Empty for the world.
  std::string name;
  /// OpenCV's camera axes. As measured in this picture: neither filtered nor held.
  std::optional<glm::dmat4> camera_from_body;
  /// Filtered. Absent if the body or the camera has no pose, and for the world.
  std::optional<glm::dmat4> world_from_body;
  /// Reprojection error of the measured pose.
  double rms_px = 0.0;
  /// Tags that gave the pose; tags that were seen but disagreed; tags that were not seen.
  std::vector<TagId> used, rejected, missing;
  /// The pose is an earlier picture's: no tag was usable in this one.
  bool held = false;
};

struct TrackResult {
  std::vector<Detection> detections;
  /// OpenCV's camera axes (x right, y down, z forward). Absent when the world was not found.
  std::optional<glm::dmat4> world_from_camera;
  /// How the camera was found.
  BodyTrack world;
  /// One a body of the layout, in its order.
  std::vector<BodyTrack> bodies;

  /// With OpenGL's camera axes (x right, y up, z backwards).
  std::optional<glm::dmat4> world_from_camera_opengl() const;
};

class Tracker {
 public:
  /// Errors: InputError for a layout that breaks check_layout's rules or has an unknown family.
  Tracker(const CameraModel& camera, const TagLayout& layout, const TrackerOptions& options = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// Finds tags and poses in the next picture. Times are seconds and grow; a time that does not
  /// makes the filter start anew. Errors: InputError when the picture's shape is not the camera's.
  TrackResult update(const Image& picture, double time_s);

  /// The same from tags that were found already.
  TrackResult update(const std::vector<Detection>& detections, double time_s);

  /// Forgets all earlier pictures.
  void reset();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::ar
