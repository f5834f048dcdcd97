// A mirror ball as a light probe (Debevec 1998): where light comes from that a pixel of its
// photograph shows. Distances are finite: rays leave the ball's surface, not its centre.
#pragma once

#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ar/camera.h"

namespace gnomon::ar {

struct Ray {
  glm::dvec3 origin{0.0};
  /// Of unit length.
  glm::dvec3 direction{0.0, 0.0, -1.0};
};

/// The ray that a pixel sees along; absent outside what the lens images. `world_from_camera` in
/// OpenCV's axes, a rotation and translation.
std::optional<Ray> pixel_ray(const Lens& lens, const glm::dmat4& world_from_camera,
                             glm::dvec2 pixel);

struct MirrorBall {
  glm::dvec3 center_m{0.0};
  double radius_m = 0.05;
  /// Share of the light that it mirrors, in (0, 1].
  glm::dvec3 reflectance{1.0};
};

struct Reflection {
  /// Begins on the ball.
  Ray ray;
  /// Between the ball's normal and the ray that came: 1 at the middle of its picture, 0 at the rim.
  double cos_incidence = 0.0;
};

/// What becomes of a ray from outside of the ball; absent where it passes.
std::optional<Reflection> reflect(const MirrorBall& ball, const Ray& ray);

/// The point of the ball that shows a viewer at `eye` the place `towards` or, with w = 0, the
/// direction `towards`; absent where none does, since it is hidden behind the ball. Precondition:
/// both are outside of the ball. Holds: the sight of the point is reflected to the place within
/// 1e-7 rad.
std::optional<glm::dvec3> mirror_point(const MirrorBall& ball, const glm::dvec3& eye,
                                       const glm::dvec4& towards);

/// The ball in a picture.
struct BallOutline {
  /// Pixels that may show it, clipped to the picture: [x0, x1) x [y0, y1).
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// Its mean radius in the picture, in pixels.
  double radius_px = 0.0;
  /// Share of the outline that lies in the picture, in [0, 1].
  double inside = 0.0;
};

/// Absent when the camera is in the ball, or no part of the outline is imaged.
std::optional<BallOutline> ball_outline(const MirrorBall& ball, const Lens& lens,
                                        const glm::dmat4& world_from_camera, int width, int height);

}  // namespace gnomon::ar
