// The file that names what was captured of a real scene: its photograph, its light probe and its
// model (Gibson 2003, section 3). Format: docs/capture.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "ar/mirror_ball.h"

namespace gnomon::ar {

inline constexpr std::string_view kCaptureFormat = "gnomon-capture 1";
/// The file's name in its folder.
inline constexpr std::string_view kCaptureName = "capture.toml";

/// A mirror ball, photographed by the camera of the photograph.
struct BallProbe {
  /// The list of exposures.
  std::filesystem::path brackets;
  MirrorBall ball;
  /// In OpenCV's axes.
  glm::dmat4 world_from_camera{1.0};
};

/// Radiance from all around a point, seen from inside: rows from +y down, the middle column towards
/// `towards`, the right half to the right of it.
struct LatlongProbe {
  std::filesystem::path picture;
  glm::dvec3 center_m{0.0};
  /// Horizontal, of unit length.
  glm::dvec3 towards{0.0, 0.0, -1.0};
  /// The photograph's radiance over the picture's, a channel at a time; absent: found from the
  /// patches that both see.
  std::optional<glm::dvec3> scale;
};

/// Sunlight in the scene.
struct CapturedSun {
  /// Towards it, of unit length.
  glm::dvec3 direction{0.0, 1.0, 0.0};
  /// Of a surface that faces it, in the photograph's radiance times steradian; absent: found from
  /// patches that it lights beside those that it does not.
  std::optional<glm::dvec3> irradiance;
  /// Names of the model's surfaces that it shines through.
  std::vector<std::string> through;
};

struct CaptureFile {
  std::filesystem::path file, camera;
  /// The picture to be augmented, and its view's list of exposures.
  std::filesystem::path photograph, photograph_brackets;
  /// Absent: the list of exposures says it.
  std::optional<double> exposure_time_s;
  /// Of the photograph, in OpenCV's axes.
  glm::dmat4 world_from_camera{1.0};
  std::variant<BallProbe, LatlongProbe> probe;
  std::optional<CapturedSun> sun;
  std::filesystem::path model;
  /// Names of the model's nodes that are not in the scene.
  std::vector<std::string> leave_out;
  int patches = 1500;
};

/// Reads FOLDER/capture.toml. Throws InputError "FILE:LINE: ...": a syntax error, another format,
/// an unknown or missing key, a value of a wrong type or out of range, a pose that is none, a file
/// that is not there.
CaptureFile read_capture(const std::filesystem::path& folder);

}  // namespace gnomon::ar
