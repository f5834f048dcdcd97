// What happens to a photograph on its way from the lens to the program. Light is what a response
// says of values; noise is of values.
// Invariant: the same for the same arguments; random numbers are raw words of std::mt19937.
#pragma once

#include <cstdint>
#include <span>

#include "ar/image.h"
#include "ar/response.h"
#include "ar/tags.h"

namespace gnomon::apps::study {

/// The value of a channel whose light is nearest to this.
std::uint8_t value_of_light(const ar::Response& response, std::size_t channel, double light);

/// Out of focus: light spread by a Gaussian. Sigma 0 is the picture itself.
ar::Image blurred(const ar::Image& picture, double sigma_px, const ar::Response& response);

/// So much of the light; 1 is the picture itself.
ar::Image darkened(const ar::Image& picture, double factor, const ar::Response& response);

/// Of that width, each pixel the mean light of its area. Precondition: not wider than the picture,
/// of a width that gives a whole height.
ar::Image shrunk_to(const ar::Image& picture, int width, const ar::Response& response);

/// Values v become 255 (v / 255)^gamma.
ar::Image bent(const ar::Image& picture, double gamma);

/// Each square's border and this share of its area, from one of its four sides on, under something
/// of one colour. A share of 0 is the picture itself.
ar::Image covered(const ar::Image& picture, std::span<const ar::TagCorners> tags, double share,
                  std::size_t side);

/// Each value and Gaussian noise (the sum of eight bytes) of that standard deviation; 0 is the
/// picture itself.
ar::Image noisy(const ar::Image& picture, double sigma, std::uint32_t seed);

}  // namespace gnomon::apps::study
