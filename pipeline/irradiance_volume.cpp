#include "pipeline/irradiance_volume.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

constexpr double kPi = std::numbers::pi;

/// Adds a triangle of radiance that is all seen, in four parts where it is near.
void add_triangle(const std::array<glm::dvec3, 3>& t, const glm::dvec3& radiance, int depth,
                  Harmonics& sum) {
  const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
  const double edge =
      std::max({glm::length(t[1] - t[0]), glm::length(t[2] - t[1]), glm::length(t[0] - t[2])});
  const double distance = glm::length(middle);
  if (depth > 0 && distance < 2.0 * edge) {
    const glm::dvec3 ab = (t[0] + t[1]) * 0.5, bc = (t[1] + t[2]) * 0.5, ca = (t[2] + t[0]) * 0.5;
    add_triangle({t[0], ab, ca}, radiance, depth - 1, sum);
    add_triangle({ab, t[1], bc}, radiance, depth - 1, sum);
    add_triangle({ca, bc, t[2]}, radiance, depth - 1, sum);
    add_triangle({ab, bc, ca}, radiance, depth - 1, sum);
    return;
  }
  if (!(distance > 0.0)) return;
  const std::array<double, 9> y = harmonics(middle / distance);
  const glm::dvec3 weighted = radiance * solid_angle(t[0], t[1], t[2]);
  for (std::size_t i = 0; i < 9; ++i) sum[i] += weighted * y[i];
}

Harmonics radiance_at(const LitScene& scene, const PatchVisibility& visibility,
                      const glm::dvec3& point, int samples) {
  Harmonics sum{};
  const PatchModel& model = scene.model;
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const Patch& patch = model.patches[i];
    const glm::dvec3 to = patch.center - point;
    if (scene.radiance[i] == glm::vec3(0.0f) || !(glm::dot(to, patch.normal) < 0.0)) continue;
    const double seen = visibility.visible_share(patch, point, glm::normalize(to), samples);
    if (seen == 0.0) continue;
    add_triangle({model.corner(patch, 0) - point, model.corner(patch, 1) - point,
                  model.corner(patch, 2) - point},
                 glm::dvec3(scene.radiance[i]) * seen, 3, sum);
  }
  return sum;
}

/// In the open: most of what is seen around is seen from the front.
bool is_open(const PatchVisibility& visibility, const glm::dvec3& point) {
  constexpr int kDirections = 32;
  int fronts = 0, hits = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections, r = std::sqrt(1.0 - z * z);
    const double turn = 2.0 * kPi * 0.6180339887498949 * i;
    const auto hit = visibility.trace(point, {r * std::cos(turn), r * std::sin(turn), z});
    if (hit.patch == PatchVisibility::kNone) continue;
    ++hits;
    fronts += hit.front ? 1 : 0;
  }
  return hits == 0 || 2 * fronts > hits;
}

}  // namespace

std::array<double, 9> harmonics(const glm::dvec3& d) {
  const double zero = 0.5 * std::sqrt(1.0 / kPi), one = std::sqrt(0.75 / kPi);
  const double two = 0.5 * std::sqrt(15.0 / kPi);
  return {zero,
          one * d.y,
          one * d.z,
          one * d.x,
          two * d.x * d.y,
          two * d.y * d.z,
          0.25 * std::sqrt(5.0 / kPi) * (3.0 * d.z * d.z - 1.0),
          two * d.x * d.z,
          0.5 * two * (d.x * d.x - d.y * d.y)};
}

glm::dvec3 irradiance(const Harmonics& radiance, const glm::dvec3& normal) {
  const std::array<double, 9> y = harmonics(normal);
  glm::dvec3 sum = radiance[0] * (kPi * y[0]);
  for (std::size_t i = 1; i < 4; ++i) sum += radiance[i] * (2.0 * kPi / 3.0 * y[i]);
  for (std::size_t i = 4; i < 9; ++i) sum += radiance[i] * (0.25 * kPi * y[i]);
  return glm::max(sum, glm::dvec3(0.0));
}

double solid_angle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
  const double base =
      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(volume, base);
}

IrradianceVolume::IrradianceVolume(const LitScene& scene, const PatchVisibility& visibility,
                                   const IrradianceVolumeOptions& options) {
  for (const Patch& patch : scene.model.patches) {
    if (patch.distant) continue;
    for (std::size_t k = 0; k < 3; ++k) box_.add(scene.model.corner(patch, k));
  }
  const glm::dvec3 extent = box_.high - box_.low;
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::ceil(extent[axis] / options.spacing_m);
    size_[static_cast<std::size_t>(axis)] =
        static_cast<std::size_t>(std::clamp(cells, 1.0, static_cast<double>(options.longest)));
    count *= size_[static_cast<std::size_t>(axis)];
  }
  radiance_.resize(count);
  weight_.resize(count);
  raster::for_each_chunk(count, 1, options.threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::array<std::size_t, 3> at{i % size_[0], i / size_[0] % size_[1],
                                          i / size_[0] / size_[1]};
      glm::dvec3 point(0.0);
      // Cells' middles, so that no point lies in a wall.
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<int>(axis);
        point[k] = box_.low[k] + extent[k] * (static_cast<double>(at[axis]) + 0.5) /
                                     static_cast<double>(size_[axis]);
      }
      weight_[i] = is_open(visibility, point) ? 1.0 : 0.0;
      if (weight_[i] > 0.0) radiance_[i] = radiance_at(scene, visibility, point, options.samples);
    }
  });
}

Harmonics IrradianceVolume::at(const glm::dvec3& point) const {
  std::array<std::size_t, 3> low{}, high{};
  glm::dvec3 part(0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<int>(axis);
    const double cells = static_cast<double>(size_[axis]);
    const double extent = box_.high[k] - box_.low[k];
    const double place =
        extent > 0.0 ? std::clamp((point[k] - box_.low[k]) / extent * cells - 0.5, 0.0, cells - 1.0)
                     : 0.0;
    low[axis] = static_cast<std::size_t>(place);
    high[axis] = std::min(low[axis] + 1, size_[axis] - 1);
    part[k] = place - static_cast<double>(low[axis]);
  }
  Harmonics sum{};
  double weights = 0.0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    std::size_t index = 0;
    double weight = 1.0;
    for (std::size_t axis = 3; axis-- > 0;) {
      const bool up = (corner >> axis & 1) != 0;
      const double p = part[static_cast<int>(axis)];
      index = index * size_[axis] + (up ? high : low)[axis];
      weight *= up ? p : 1.0 - p;
    }
    weight *= weight_[index];
    if (weight == 0.0) continue;
    weights += weight;
    for (std::size_t i = 0; i < 9; ++i) sum[i] += radiance_[index][i] * weight;
  }
  if (weights > 0.0) {
    for (glm::dvec3& coefficient : sum) coefficient /= weights;
  }
  return sum;
}

glm::dvec3 IrradianceVolume::irradiance(const glm::dvec3& point, const glm::dvec3& normal) const {
  return pipeline::irradiance(at(point), normal);
}

}  // namespace gnomon::pipeline
