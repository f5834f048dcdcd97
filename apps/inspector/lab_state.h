// What a student sets in the lab: a stage, where camera, light and object are, and how shadows are
// found. A state is a small JSON file, "gnomon-lab" version 1 (docs/inspector.md), so that a page
// and the program draw the same bytes.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace gnomon::apps::inspector {

/// Thrown for what is no state. what() is one line: the field, what is wrong, the value.
class LabError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What stands on the floor; one for each exercise of docs/lesson.md.
enum class LabStage { camera_in_shadow, missing_cap, overflow, open_mesh, acne };

enum class LabMethod { zpass, zfail, automatic, shadow_map };

struct LabState {
  LabStage stage = LabStage::camera_in_shadow;
  /// Pixels, 16 to 1920.
  int width = 640, height = 480;

  /// The camera looks at a point 0.6 m above the floor's middle, from this direction and distance.
  double camera_turn_deg = 30.0, camera_tilt_deg = 25.0, camera_distance_m = 5.0;
  /// Of the lamp, a point.
  double light_x_m = 1.0, light_y_m = 3.5, light_z_m = 0.8;
  /// Added to where the stage has its object.
  double object_x_m = 0.0, object_y_m = 0.0, object_z_m = 0.0, object_turn_deg = 0.0;

  LabMethod method = LabMethod::zfail;
  /// Counts stop at 0 and 255 (GL_INCR, GL_DECR, faces that add first) instead of wrapping.
  bool saturate = false;
  bool front_cap = true, back_cap = true;
  /// Length of volumes beyond the caster; 0: to infinity.
  double length_m = 0.0;
  /// The outline as renderers find it that ask for closed meshes.
  bool classical_outline = false;
  /// Plates of the stage `overflow`, 1 to 600.
  int plates = 40;

  /// Texels a side, 16 to 2048, and the offset of the map's depths.
  int map_size = 256;
  double map_offset_factor = 0.0, map_offset_units = 0.0;
  bool map_filtered = false;
  bool depth_16_bits = false;

  bool operator==(const LabState&) const = default;
};

/// A state with the stage's own view, to begin with.
LabState starting_state(LabStage stage);

/// Reads JSON; fields that are absent are those of the stage's starting state. Throws LabError.
LabState read_lab_state(std::string_view json);

/// With all fields.
std::string to_json(const LabState& state);

}  // namespace gnomon::apps::inspector
