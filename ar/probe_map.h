// A light probe as a map of directions around its centre (pipeline/lit_scene.h), and a
// latitude-longitude picture as rays.
#pragma once

#include <functional>
#include <optional>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ar/camera.h"
#include "ar/capture_file.h"
#include "ar/image_file.h"
#include "ar/mirror_ball.h"
#include "pipeline/lit_scene.h"
#include "pipeline/patch_light.h"

namespace gnomon::ar {

inline constexpr int kProbeMapWidth = 256, kProbeMapHeight = 128;

/// The value between a picture's pixels, their centres at integers; outside, the nearest pixel's.
glm::dvec3 bilinear(const FloatImage& picture, glm::dvec2 place);

/// A ball's photograph, its radiance already divided by the ball's reflectance.
struct BallPicture {
  const FloatImage& radiance;
  const Lens& lens;
  glm::dmat4 world_from_camera{1.0};
  MirrorBall ball;
  /// Pixels nearer to the rim than this cosine of incidence show the ball's surroundings too.
  double least_cos = 0.1;

  /// The reflected ray of a place in the picture; absent beside the ball and at its rim.
  std::optional<Ray> ray(glm::dvec2 place) const;
  /// What the ball shows of a place or, with w = 0, a direction; absent at its rim and behind it.
  std::optional<glm::dvec3> seen(const glm::dvec4& towards) const;
};

/// A latitude-longitude picture with one pixel more on each side, which repeats what is beyond that
/// side, so that every pixel of the picture has neighbours.
class LatlongPicture {
 public:
  /// Halved in size as often as its pixels are more than 2^21. Precondition: not empty.
  LatlongPicture(FloatImage picture, const LatlongProbe& probe);

  const FloatImage& bordered() const { return bordered_; }
  FloatImage& bordered() { return bordered_; }
  /// The ray of a place in the bordered picture.
  Ray ray(glm::dvec2 place) const;
  /// The radiance from a direction.
  glm::dvec3 seen(const glm::dvec3& direction) const;

 private:
  FloatImage bordered_;
  glm::dvec3 center_m_, ahead_, right_;
};

/// What is seen from the map's centre: `seen` of the place where a direction first meets the
/// model, or of the direction itself; where that is absent, the radiance of the model's patch;
/// where there is none either, the mean of the map's rest. Texels are means over their area.
pipeline::DirectionMap make_direction_map(
    const glm::dvec3& center_m,
    const std::function<std::optional<glm::dvec3>(const glm::dvec4&)>& seen,
    const std::vector<glm::vec3>& patch_radiance, const pipeline::PatchVisibility& patches,
    int threads);

}  // namespace gnomon::ar
