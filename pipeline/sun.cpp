#include "pipeline/sun.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/basis.h"
#include "pipeline/bounds.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

/// How far away the patch is, in diagonals of the scene: shadows of it are as wide as a parallel
/// light's to half a percent, and float32 coordinates there are still good to a tenth of a
/// millimetre a metre of the scene.
constexpr double kDiagonals = 200.0;

double solid_angle() { return 2.0 * std::numbers::pi * (1.0 - std::cos(kSunRadiusRad)); }

}  // namespace

void add_sun(PatchModel& model, const glm::dvec3& direction, std::vector<std::uint32_t> clear) {
  raster::require(!model.patches.empty() && !model.patches.back().distant,
                  "a scene of patches has one sun at most");
  raster::require(std::ranges::all_of(clear, [&](auto s) { return s < model.surfaces.size(); }),
                  "a clear surface is one of the scene's");
  Bounds box;
  for (const PatchVertex& vertex : model.vertices) box.add(glm::dvec3(vertex.position));
  const double distance = kDiagonals * glm::length(box.high - box.low);
  // An equilateral triangle of this area, seen head on.
  const double area = solid_angle() * distance * distance;
  const double reach = std::sqrt(4.0 * area / (3.0 * std::sqrt(3.0)));
  const glm::dvec3 center = box.center() + direction * distance;
  const Basis basis = basis_about(direction);
  std::array<std::uint32_t, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(k) / 3.0;
    corners[k] = static_cast<std::uint32_t>(model.vertices.size());
    model.vertices.push_back(
        {glm::vec3(center + (basis.u * std::cos(turn) + basis.v * std::sin(turn)) * reach),
         glm::vec3(-direction)});
  }
  // Its front is seen from the scene.
  const auto surface = static_cast<std::uint32_t>(model.surfaces.size());
  if (glm::dot(make_patch(model, corners, surface).normal, direction) > 0.0)
    std::swap(corners[1], corners[2]);
  model.surfaces.emplace_back("sun");
  model.clear_surfaces = std::move(clear);
  model.patches.push_back(make_patch(model, corners, surface));
  model.patches.back().distant = true;
}

std::uint32_t sun_patch(const PatchModel& model) {
  raster::require(!model.patches.empty() && model.patches.back().distant, "the scene has a sun");
  return static_cast<std::uint32_t>(model.patches.size() - 1);
}

glm::dvec3 sun_radiance(const glm::dvec3& irradiance) { return irradiance / solid_angle(); }

}  // namespace gnomon::pipeline
