#include "pipeline/lit_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raster/check.h"

namespace gnomon::pipeline {

glm::dvec3 DirectionMap::direction(double u, double v) {
  const double longitude = std::numbers::pi * (1.0 - 2.0 * u);
  const double latitude = std::numbers::pi * (0.5 - v);
  return {std::sin(longitude) * std::cos(latitude), std::sin(latitude),
          std::cos(longitude) * std::cos(latitude)};
}

void DirectionMap::place(const glm::dvec3& direction, double& u, double& v) {
  const double across = std::hypot(direction.x, direction.z);
  u = 0.5 - 0.5 / std::numbers::pi * std::atan2(direction.x, direction.z);
  v = 0.5 - std::atan2(direction.y, across) / std::numbers::pi;
}

const glm::vec3& DirectionMap::at(const glm::dvec3& direction) const {
  double u = 0.0, v = 0.0;
  place(direction, u, v);
  const auto index = [](double share, int count) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(share * count), 0, count - 1));
  };
  return radiance[index(v, height) * static_cast<std::size_t>(width) + index(u, width)];
}

std::vector<glm::vec3> at_vertices(const PatchModel& model, std::span<const glm::vec3> of_patches) {
  raster::require(of_patches.size() == model.patches.size(), "a value belongs to each patch");
  std::vector<glm::dvec3> sum(model.vertices.size(), glm::dvec3(0.0));
  std::vector<double> area_m2(model.vertices.size(), 0.0);
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const Patch& patch = model.patches[i];
    for (const std::uint32_t vertex : patch.vertices) {
      sum[vertex] += patch.area_m2 * glm::dvec3(of_patches[i]);
      area_m2[vertex] += patch.area_m2;
    }
  }
  std::vector<glm::vec3> result(model.vertices.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (area_m2[i] > 0.0) result[i] = glm::vec3(sum[i] / area_m2[i]);
  }
  return result;
}

}  // namespace gnomon::pipeline
