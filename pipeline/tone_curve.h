// The camera's response as the map T from radiance to pixel values (Gibson 2003, section 7.1).
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

namespace gnomon::pipeline {

/// A channel's table: the radiance whose pixel value is exactly v. Between values T is linear in
/// radiance.
struct ToneCurve {
  /// Strictly increasing; [0] is 0 or more.
  std::array<std::array<float, 256>, 3> radiance_from_value{};

  /// The pixel value of a radiance, in [0, 255], not rounded. NaN gives 0.
  glm::dvec3 value(const glm::dvec3& radiance) const;
  double value(std::size_t channel, double radiance) const;
  /// The same, found from the whole value `near` (0 to 254) on, which becomes the one below the
  /// result: for a row of radiances that change little from one to the next.
  double value_from(std::size_t channel, double radiance, std::size_t& near) const;
  /// The radiance of a pixel value in [0, 255], clamped to that.
  double radiance(std::size_t channel, double value) const;

  /// T(L) = 255 (L / white)^(1 / gamma), the same for all channels.
  /// Misuse: gamma not in [0.1, 10], white not positive.
  static ToneCurve from_gamma(double gamma, double white);
};

}  // namespace gnomon::pipeline
