#include "raster/texture.h"

#include <cmath>

#include "raster/unorm.h"

namespace gnomon::raster {

namespace {

/// Texel index of an unwrapped one (OpenGL 4.6, table 8.20).
int wrap_index(std::int64_t i, int size, Wrap wrap) {
  if (wrap == Wrap::clamp_to_edge) return static_cast<int>(i < 0 ? 0 : (i >= size ? size - 1 : i));
  const std::int64_t period = wrap == Wrap::repeat ? size : 2 * static_cast<std::int64_t>(size);
  const std::int64_t in_period = ((i % period) + period) % period;
  return static_cast<int>(in_period < size ? in_period : period - 1 - in_period);
}

glm::vec4 texel(const Texture& texture, std::int64_t i, std::int64_t j) {
  const int x = wrap_index(i, texture.width, texture.wrap_s);
  const int y = wrap_index(j, texture.height, texture.wrap_t);
  return to_floats(texture.texels[static_cast<std::size_t>(y) * texture.width + x]);
}

/// A texel coordinate whose integer part is safe to convert.
float texel_coordinate(float coordinate, int size) {
  const float scaled = coordinate * static_cast<float>(size);
  constexpr float kLimit = 1073741824.0f;
  return scaled > -kLimit && scaled < kLimit ? scaled : 0.0f;
}

}  // namespace

glm::vec4 sample(const Texture& texture, float s, float t) {
  float u = texel_coordinate(s, texture.width);
  float v = texel_coordinate(t, texture.height);
  if (texture.filter == Filter::nearest)
    return texel(texture, static_cast<std::int64_t>(std::floor(u)),
                 static_cast<std::int64_t>(std::floor(v)));
  u = u - 0.5f;
  v = v - 0.5f;
  const float u0 = std::floor(u), v0 = std::floor(v);
  const float fu = u - u0, fv = v - v0;
  const auto i = static_cast<std::int64_t>(u0), j = static_cast<std::int64_t>(v0);
  const glm::vec4 bottom = texel(texture, i, j) * (1.0f - fu) + texel(texture, i + 1, j) * fu;
  const glm::vec4 top = texel(texture, i, j + 1) * (1.0f - fu) + texel(texture, i + 1, j + 1) * fu;
  return bottom * (1.0f - fv) + top * fv;
}

}  // namespace gnomon::raster
