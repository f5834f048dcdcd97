// A calibrated camera with its lens, and the files that describe one.
// Pixels: the first pixel's centre is (0, 0), x right, y down (OpenCV). Camera frame: x right, y
// down, z forward, metres. Normalised coordinates are (x / z, y / z).
// Source of the lens equations: OpenCV's documentation of calib3d and of its fisheye module.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace gnomon::ar {

enum class LensKind {
  /// k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]: radial (polynomial or rational),
  /// tangential, thin prism, tilted sensor.
  brown_conrady,
  /// k1 k2 k3 k4 on the angle from the axis (ROS: "equidistant").
  fisheye
};

struct CameraModel {
  /// The picture that the numbers belong to, in pixels; 0 x 0 when the file does not say.
  int width = 0, height = 0;
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0;
  LensKind lens = LensKind::brown_conrady;
  /// 0, 4, 5, 8, 12 or 14 values in OpenCV's order (fisheye: 0 or 4).
  std::vector<double> distortion;
};

/// Square pixels, no distortion, the axis through the picture's middle.
CameraModel pinhole_camera(int width, int height, double focal_px);

/// Pixels from the eye to a picture of this height with this field of view.
double focal_for(int height, double fov_y_rad);

/// Reads OpenCV YAML, ROS camera_info (YAML or JSON, file or message form) or BoofCV's pinhole
/// YAML.
/// Errors: InputError for a file over 4 MiB, not YAML, without a camera matrix, with numbers that
/// are not finite, focal lengths not positive, a skewed pixel grid, a count of coefficients that no
/// model has, an unknown distortion model. Holds afterwards: Lens accepts the result.
CameraModel read_camera(const std::filesystem::path& file);

/// The camera for pictures of this size. A camera without a size takes it; one of another size of
/// the same shape is scaled (pixel centres at integers).
/// Errors: InputError naming both sizes when the shapes differ by more than a pixel.
CameraModel camera_for_picture(const CameraModel& camera, int width, int height);

/// The lens as a function and its inverse. The inverse is that of the centre's own branch: radial
/// distortion is followed only as far as it grows with the radius.
class Lens {
 public:
  /// Misuse: numbers not finite, focal length not positive, a count that no model has.
  explicit Lens(const CameraModel& camera);

  const CameraModel& camera() const { return camera_; }

  /// Distorted normalised coordinates; total (no check of the branch).
  glm::dvec2 distort(glm::dvec2 normalised) const;

  /// Normalised coordinates of a pixel; absent outside what the lens can image.
  /// Holds: distort of the result is the pixel within 1e-9 of the focal length.
  std::optional<glm::dvec2> undistort(glm::dvec2 pixel) const;

  /// The pixel of a point; absent behind the camera (z <= 0) or outside what the lens can image.
  std::optional<glm::dvec2> project(glm::dvec3 camera_point) const;

  /// Largest undistorted normalised radius that the lens images, at most 100 (89.4 degrees).
  double max_radius() const { return max_radius_; }

 private:
  double radial_scale(double r2) const;
  double distorted_radius(double radius) const;
  double undistorted_radius(double distorted) const;
  glm::dvec2 brown_untilted(glm::dvec2 normalised) const;
  glm::dvec2 pixel_from_distorted(glm::dvec2 distorted) const;

  CameraModel camera_;
  /// The 14 coefficients, absent ones 0.
  double k_[14] = {};
  bool tilted_ = false;
  glm::dmat3 tilt_{1.0}, untilt_{1.0};
  double max_radius_ = 0.0, max_distorted_ = 0.0;
};

}  // namespace gnomon::ar
