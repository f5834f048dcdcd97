// Poses of rigid bodies from the corners of their tags.
// A square seen almost frontally has two poses with nearly the same picture (the mirror image of
// its tilt). Both are found (IPPE: Collins and Bartoli 2014), refined on the distorted pixels, and
// judged by their errors together with what is known beforehand. Several tags of a body are fitted
// at once, so that they disambiguate each other, and a tag that does not belong is left out. Camera
// axes: OpenCV's (x right, y down, z forward). Metres and pixels.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "ar/camera.h"
#include "ar/tags.h"

namespace gnomon::ar {

/// A tag in a picture, and where its corners are on its body.
struct TagView {
  std::array<glm::dvec3, 4> body_m{};
  TagCorners corners_px{};
};

struct PoseOptions {
  /// Standard deviation of a corner's coordinate that judgements assume.
  double corner_noise_px = 0.3;
  /// While a tag's rms error exceeds this, one tag is left out if that halves the error of the
  /// rest.
  double outlier_px = 3.0;
};

/// A local minimum of the reprojection error.
struct PoseFit {
  glm::dmat4 camera_from_body{1.0};
  /// Over the corners of the tags used: root of the mean squared distance.
  double rms_px = 0.0;
  /// Sum of squared errors over the noise's variance, with a fixed charge for each tag left out.
  double chi2 = 0.0;
  /// One a view.
  std::vector<bool> used;
};

/// All distinct minima, least chi2 first; one or two for a single tag; none when the views are
/// degenerate or outside what the lens images. `prior` is one more start for the fit.
std::vector<PoseFit> body_poses(const Lens& lens, std::span<const TagView> views,
                                const PoseOptions& options = {},
                                const std::optional<glm::dmat4>& prior = std::nullopt);

/// The same for one tag in its own frame.
std::vector<PoseFit> tag_poses(const Lens& lens, const TagCorners& corners_px, double size_m,
                               const PoseOptions& options = {});

/// Remembers which of two mirrored poses a body has. A pose near the last one is kept until the
/// errors of the frames since have said more clearly than `threshold` that the other is the right
/// one (a cumulative sum test, Page 1954), so that noise does not make it flip and a wrong start is
/// corrected.
class PoseChooser {
 public:
  PoseChooser() = default;
  explicit PoseChooser(double threshold) : threshold_(threshold) {}

  /// Index of the pose to take from fits of one frame (least chi2 first, not empty).
  std::size_t choose(std::span<const PoseFit> fits, const std::optional<glm::dmat4>& prior);

  void reset() { evidence_ = 0.0; }

 private:
  double threshold_ = 20.0;
  double evidence_ = 0.0;
};

/// Angle of the rotation between two rigid transforms, in radians.
double rotation_between_rad(const glm::dmat4& a, const glm::dmat4& b);

/// How far the entries of a rotation's product with its transpose may be from the identity's:
/// matrices written with six digits are still rotations.
inline constexpr double kRigidTolerance = 1e-5;

/// Whether a matrix is a rotation, within kRigidTolerance.
bool is_rotation(const glm::dmat3& m);

/// Inverse of a rotation and translation.
glm::dmat4 rigid_inverse(const glm::dmat4& m);

/// OpenCV's camera axes to OpenGL's (x right, y up, z backwards), and back: its own inverse.
glm::dmat4 opengl_from_opencv_axes();

}  // namespace gnomon::ar
