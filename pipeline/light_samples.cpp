#include "pipeline/light_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <glm/geometric.hpp>

#include "pipeline/basis.h"
#include "pipeline/finite.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

// Cosine and sine of the golden angle, pi (3 - sqrt 5): literals, because a library's cosine is not
// the same on every machine.
constexpr double kGoldenCos = -0.73736887807831963;
constexpr double kGoldenSin = 0.67549029426152362;

glm::vec3 middle_of(const Scene& scene) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  glm::vec3 low(kInfinity), high(-kInfinity);
  for (const Object& object : scene.objects) {
    raster::require(object.model != nullptr, "an object has a model");
    for (const Part& part : object.model->parts) {
      for (const glm::vec4& p : part.mesh.positions) {
        const glm::vec3 world(object.world_from_model * p);
        if (!is_finite(world)) continue;
        low = glm::min(low, world);
        high = glm::max(high, world);
      }
    }
  }
  if (!(low.x <= high.x)) return glm::vec3(0.0f);
  return low * 0.5f + high * 0.5f;
}

}  // namespace

std::vector<Light> sample_light(const Light& light, const glm::vec3& facing) {
  raster::require(light.samples >= 1 && light.samples <= kMaxLightSamples,
                  "a light has 1 to 1024 samples");
  raster::require(std::isfinite(light.radius) && light.radius >= 0.0f,
                  "a light's radius is finite and not negative");
  raster::require(light.share >= 0.0f && light.share <= 1.0f, "a light's share is 0 to 1");
  Light centre = light;
  centre.samples = 1;
  centre.radius = 0.0f;
  if (light.samples == 1 || light.radius == 0.0f) return {centre};

  const bool directional = light.position.w == 0.0f;
  const glm::dvec3 position(light.position);
  const glm::dvec3 towards = directional ? position : glm::dvec3(facing) - position;
  const double distance = glm::length(towards);
  // A light in the very middle of the scene has no side that it shows.
  const Basis disc = basis_about(distance > 0.0 ? towards / distance : glm::dvec3(0.0, -1.0, 0.0));
  const double scale = directional ? distance : 1.0;
  const int n = light.samples;
  double x = 1.0, y = 0.0;
  std::vector<Light> samples;
  for (int i = 0; i < n; ++i) {
    const double r = light.radius * scale * std::sqrt((i + 0.5) / n);
    Light sample = centre;
    sample.name = light.name + " " + std::to_string(i + 1) + "/" + std::to_string(n);
    sample.position =
        glm::vec4(glm::vec3(position + disc.u * (r * x) + disc.v * (r * y)), light.position.w);
    if (directional) {
      sample.position = glm::vec4(glm::normalize(glm::vec3(sample.position)), 0.0f);
    }
    sample.color = light.color / static_cast<float>(n);
    sample.share = light.share / static_cast<float>(n);
    samples.push_back(sample);
    const double turned = x * kGoldenCos - y * kGoldenSin;
    y = x * kGoldenSin + y * kGoldenCos;
    x = turned;
  }
  return samples;
}

std::vector<Light> sample_lights(const Scene& scene) {
  const glm::vec3 middle = middle_of(scene);
  std::vector<Light> lights;
  for (const Light& light : scene.lights) {
    for (const Light& sample : sample_light(light, middle)) lights.push_back(sample);
  }
  return lights;
}

}  // namespace gnomon::pipeline
