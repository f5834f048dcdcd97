#include "ar/probe_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ar/pose.h"
#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::ar {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::int64_t kMostLatlongPixels = std::int64_t{1} << 21;
/// A texel of the map is looked at in so many places a side.
constexpr int kPlaces = 2;

glm::dvec3 value_at(const FloatImage& picture, int x, int y) {
  const float* v =
      picture.at(std::clamp(x, 0, picture.width - 1), std::clamp(y, 0, picture.height - 1));
  return {v[0], v[1], v[2]};
}

/// Means of 2 x 2 pixels; an odd last column or row is left out.
FloatImage halved(const FloatImage& picture) {
  FloatImage half{std::max(1, picture.width / 2), std::max(1, picture.height / 2), {}};
  half.pixels.resize(static_cast<std::size_t>(half.width) * half.height * 3);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const glm::dvec3 mean =
          (value_at(picture, 2 * x, 2 * y) + value_at(picture, 2 * x + 1, 2 * y) +
           value_at(picture, 2 * x, 2 * y + 1) + value_at(picture, 2 * x + 1, 2 * y + 1)) /
          4.0;
      for (int c = 0; c < 3; ++c) half.at(x, y)[c] = static_cast<float>(mean[c]);
    }
  }
  return half;
}

}  // namespace

glm::dvec3 bilinear(const FloatImage& picture, glm::dvec2 place) {
  const glm::dvec2 low = glm::floor(place), part = place - low;
  const int x = static_cast<int>(low.x), y = static_cast<int>(low.y);
  return glm::mix(glm::mix(value_at(picture, x, y), value_at(picture, x + 1, y), part.x),
                  glm::mix(value_at(picture, x, y + 1), value_at(picture, x + 1, y + 1), part.x),
                  part.y);
}

std::optional<Ray> BallPicture::ray(glm::dvec2 place) const {
  const std::optional<Ray> sight = pixel_ray(lens, world_from_camera, place);
  if (!sight) return std::nullopt;
  const std::optional<Reflection> reflection = reflect(ball, *sight);
  if (!reflection || reflection->cos_incidence < least_cos) return std::nullopt;
  return reflection->ray;
}

std::optional<glm::dvec3> BallPicture::seen(const glm::dvec4& towards) const {
  const glm::dvec3 eye(world_from_camera[3]);
  const std::optional<glm::dvec3> point = mirror_point(ball, eye, towards);
  if (!point) return std::nullopt;
  const glm::dvec3 normal = (*point - ball.center_m) / ball.radius_m;
  if (glm::dot(normal, glm::normalize(eye - *point)) < least_cos) return std::nullopt;
  const std::optional<glm::dvec2> pixel =
      lens.project(glm::dvec3(rigid_inverse(world_from_camera) * glm::dvec4(*point, 1.0)));
  if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x > radiance.width - 1.0 ||
      pixel->y > radiance.height - 1.0)
    return std::nullopt;
  return bilinear(radiance, *pixel);
}

LatlongPicture::LatlongPicture(FloatImage picture, const LatlongProbe& probe)
    : center_m_(probe.center_m),
      ahead_(probe.towards),
      right_(glm::cross(probe.towards, glm::dvec3(0.0, 1.0, 0.0))) {
  raster::require(picture.width >= 1 && picture.height >= 1, "a probe's picture is not empty");
  while (std::int64_t{picture.width} * picture.height > kMostLatlongPixels)
    picture = halved(picture);
  const int width = picture.width, height = picture.height;
  bordered_ = {width + 2, height + 2,
               std::vector<float>(static_cast<std::size_t>(width + 2) * (height + 2) * 3)};
  for (int y = -1; y <= height; ++y) {
    // Over a pole the same row goes on half a turn away.
    const int turn = y < 0 || y >= height ? width / 2 : 0;
    for (int x = -1; x <= width; ++x) {
      const float* from = picture.at((x + turn + width) % width, std::clamp(y, 0, height - 1));
      std::copy(from, from + 3, bordered_.at(x + 1, y + 1));
    }
  }
}

Ray LatlongPicture::ray(glm::dvec2 place) const {
  const double u = (place.x - 0.5) / (bordered_.width - 2);
  const double v = (place.y - 0.5) / (bordered_.height - 2);
  const double longitude = (u - 0.5) * 2.0 * kPi, latitude = (0.5 - v) * kPi;
  return {center_m_,
          (ahead_ * std::cos(longitude) + right_ * std::sin(longitude)) * std::cos(latitude) +
              glm::dvec3(0.0, std::sin(latitude), 0.0)};
}

glm::dvec3 LatlongPicture::seen(const glm::dvec3& direction) const {
  const double across = glm::dot(direction, right_), ahead = glm::dot(direction, ahead_);
  const double u = 0.5 + std::atan2(across, ahead) / (2.0 * kPi);
  const double v = 0.5 - std::atan2(direction.y, std::hypot(across, ahead)) / kPi;
  return bilinear(bordered_, {u * (bordered_.width - 2) + 0.5, v * (bordered_.height - 2) + 0.5});
}

pipeline::DirectionMap make_direction_map(
    const glm::dvec3& center_m,
    const std::function<std::optional<glm::dvec3>(const glm::dvec4&)>& seen,
    const std::vector<glm::vec3>& patch_radiance, const pipeline::PatchVisibility& patches,
    int threads) {
  pipeline::DirectionMap map;
  map.width = kProbeMapWidth;
  map.height = kProbeMapHeight;
  map.center = glm::vec3(center_m);
  map.radiance.assign(static_cast<std::size_t>(map.width) * map.height, glm::vec3(0.0f));
  // Not of bool, whose neighbours share a byte between threads.
  std::vector<char> known(map.radiance.size(), 0);
  const auto look = [&](const glm::dvec3& direction) -> std::optional<glm::dvec3> {
    const pipeline::PatchVisibility::Hit hit = patches.trace(center_m, direction);
    const bool met = hit.patch != pipeline::PatchVisibility::kNone;
    const glm::dvec4 towards =
        met ? glm::dvec4(center_m + direction * hit.distance, 1.0) : glm::dvec4(direction, 0.0);
    if (const auto value = seen(towards)) return value;
    if (met && hit.front) return glm::dvec3(patch_radiance[hit.patch]);
    return std::nullopt;
  };
  raster::for_each_chunk(
      static_cast<std::size_t>(map.height), 4, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t y = first; y < last; ++y) {
          for (int x = 0; x < map.width; ++x) {
            glm::dvec3 sum(0.0);
            int count = 0;
            for (int k = 0; k < kPlaces * kPlaces; ++k) {
              const double u = (x + (k % kPlaces + 0.5) / kPlaces) / map.width;
              const double v =
                  (static_cast<double>(y) + (k / kPlaces + 0.5) / kPlaces) / map.height;
              if (const auto value = look(pipeline::DirectionMap::direction(u, v))) {
                sum += *value;
                ++count;
              }
            }
            if (count == 0) continue;
            const std::size_t i =
                y * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(x);
            map.radiance[i] = glm::vec3(sum / static_cast<double>(count));
            known[i] = 1;
          }
        }
      });
  glm::dvec3 sum(0.0);
  double weight = 0.0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] == 0) continue;
    const double row = static_cast<double>(i / static_cast<std::size_t>(map.width)) + 0.5;
    const double area = std::sin(kPi * row / map.height);
    sum += area * glm::dvec3(map.radiance[i]);
    weight += area;
  }
  for (std::size_t i = 0; i < known.size(); ++i)
    if (known[i] == 0 && weight > 0.0) map.radiance[i] = glm::vec3(sum / weight);
  return map;
}

}  // namespace gnomon::ar
