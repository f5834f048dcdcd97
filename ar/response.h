// The camera's response: what turns light into the file's 8-bit values, inverted. Detectors look
// for the half-way level of a blurred edge; in a picture that a concave response has brightened
// this level lies on the dark side, and black squares come out 1 to 2 % too small. Linear light has
// no such bias.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "ar/image.h"

namespace gnomon::ar {

/// Light in [0, 1] for each 8-bit value of a channel; does not fall.
struct Response {
  std::array<std::array<float, 256>, 3> light_from_value{};

  /// value = light^(1 / gamma), the same for all channels.
  /// Misuse: gamma not in [0.1, 10].
  static Response from_gamma(double gamma);
};

/// Reads {"inverse_table_rgb": [[r, g, b] x 256]}: light for each value, scaled so that the largest
/// entry is 1.
/// Errors: InputError when the table is not 256 x 3 finite numbers >= 0 that do not fall, or when a
/// channel is 0 throughout.
Response read_response(const std::filesystem::path& file);

/// A one-channel picture of floats, rows from the top.
struct LightPlane {
  int width = 0, height = 0;
  std::vector<float> values;
};

/// The picture's luma in the file's own values, in [0, 255], each pixel rounded to nearest: Rec.
/// 601 weights, as image libraries make grey.
Image grey(const Image& picture);

/// The picture's luminance in linear light, in [0, 1]: Rec. 709 weights.
LightPlane linear_light(const Image& picture, const Response& response);

}  // namespace gnomon::ar
