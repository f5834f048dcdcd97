#include "ar/response.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "ar/yaml_input.h"
#include "raster/check.h"

namespace gnomon::ar {
namespace {

void require_picture(const Image& picture) {
  raster::require(picture.width >= 0 && picture.height >= 0 &&
                      (picture.channels == 1 || picture.channels == 3 || picture.channels == 4) &&
                      picture.pixels.size() == static_cast<std::size_t>(picture.width) *
                                                   static_cast<std::size_t>(picture.height) *
                                                   static_cast<std::size_t>(picture.channels),
                  "a picture has width x height x (1, 3 or 4) bytes");
}

}  // namespace

Response Response::from_gamma(double gamma) {
  raster::require(gamma >= 0.1 && gamma <= 10.0, "a gamma lies in [0.1, 10]");
  Response response;
  for (std::size_t v = 0; v < 256; ++v) {
    const float light = static_cast<float>(std::pow(static_cast<double>(v) / 255.0, gamma));
    for (auto& channel : response.light_from_value) channel[v] = light;
  }
  return response;
}

Response read_response(const std::filesystem::path& file) {
  const YAML::Node root = yaml::load(file);
  constexpr const char* kKey = "inverse_table_rgb";
  const YAML::Node table = root[kKey];
  if (!table.IsDefined() || !table.IsSequence() || table.size() != 256) {
    yaml::fail(file, table, kKey, "expected a list of 256 triples");
  }
  Response response;
  double largest[3] = {};
  std::array<std::array<double, 3>, 256> light{};
  for (std::size_t v = 0; v < 256; ++v) {
    const std::string place = fmt::format("{}[{}]", kKey, v);
    const std::vector<double> rgb = yaml::numbers(file, table[v], place, 3);
    if (rgb.size() != 3) yaml::fail(file, table[v], place, "expected a triple");
    for (std::size_t c = 0; c < 3; ++c) {
      if (rgb[c] < (v == 0 ? 0.0 : light[v - 1][c])) {
        yaml::fail(file, table[v], fmt::format("{}[{}]", place, c),
                   fmt::format("light falls to {:g}", rgb[c]));
      }
      light[v][c] = rgb[c];
      largest[c] = rgb[c];
    }
  }
  const double scale = *std::max_element(largest, largest + 3);
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(largest[c] > 0.0)) yaml::fail(file, table, kKey, "a channel is 0 throughout");
    for (std::size_t v = 0; v < 256; ++v) {
      response.light_from_value[c][v] = static_cast<float>(light[v][c] / scale);
    }
  }
  return response;
}

Image grey(const Image& picture) {
  require_picture(picture);
  if (picture.channels == 1) return picture;
  Image result{picture.width, picture.height, 1, {}};
  const std::size_t count = static_cast<std::size_t>(picture.width) * picture.height;
  result.pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* p = picture.pixels.data() + i * picture.channels;
    // 0.299, 0.587, 0.114 in 16 bits.
    result.pixels[i] =
        static_cast<std::uint8_t>((19595u * p[0] + 38470u * p[1] + 7471u * p[2] + 32768u) >> 16);
  }
  return result;
}

LightPlane linear_light(const Image& picture, const Response& response) {
  require_picture(picture);
  LightPlane plane{picture.width, picture.height, {}};
  const std::size_t count = static_cast<std::size_t>(picture.width) * picture.height;
  plane.values.resize(count);
  const auto& table = response.light_from_value;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* p = picture.pixels.data() + i * picture.channels;
    const std::size_t g = picture.channels == 1 ? 0 : 1, b = picture.channels == 1 ? 0 : 2;
    plane.values[i] =
        0.2126f * table[0][p[0]] + 0.7152f * table[1][p[g]] + 0.0722f * table[2][p[b]];
  }
  return plane;
}

}  // namespace gnomon::ar
