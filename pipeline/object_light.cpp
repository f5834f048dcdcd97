#include "pipeline/object_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// Of the map as it is summed: texels averaged down to at most this many across.
constexpr int kWidest = 64;

/// Texels averaged in squares until the map is at most kWidest wide.
DirectionMap reduced(const DirectionMap& map) {
  const int step = std::max(1, (map.width + kWidest - 1) / kWidest);
  DirectionMap out{std::max(1, map.width / step), std::max(1, map.height / step), {}, map.center};
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      glm::dvec3 sum(0.0);
      for (int j = 0; j < step; ++j) {
        for (int i = 0; i < step; ++i) {
          const int row = std::min(y * step + j, map.height - 1);
          const int column = std::min(x * step + i, map.width - 1);
          sum += glm::dvec3(map.radiance[static_cast<std::size_t>(row * map.width + column)]);
        }
      }
      out.radiance.emplace_back(sum / static_cast<double>(step * step));
    }
  }
  return out;
}

}  // namespace

glm::vec3 linear_color(const glm::vec3& srgb) {
  const auto channel = [](float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  return {channel(srgb.x), channel(srgb.y), channel(srgb.z)};
}

DirectionMap blur(const DirectionMap& probe, double exponent) {
  const DirectionMap source = reduced(probe);
  std::vector<glm::dvec3> directions;
  std::vector<double> areas;
  for (int y = 0; y < source.height; ++y) {
    for (int x = 0; x < source.width; ++x) {
      directions.push_back(
          DirectionMap::direction((x + 0.5) / source.width, (y + 0.5) / source.height));
      areas.push_back(std::sin(std::numbers::pi * (y + 0.5) / source.height));
    }
  }
  DirectionMap out = source;
  raster::for_each_chunk(out.radiance.size(), 64, 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      glm::dvec3 sum(0.0);
      double weights = 0.0;
      for (std::size_t k = 0; k < directions.size(); ++k) {
        const double cosine = glm::dot(directions[i], directions[k]);
        if (cosine <= 0.0) continue;
        const double weight = areas[k] * std::pow(cosine, exponent);
        sum += glm::dvec3(source.radiance[k]) * weight;
        weights += weight;
      }
      if (weights > 0.0) out.radiance[i] = glm::vec3(sum / weights);
    }
  });
  return out;
}

ObjectLight::ObjectLight(const LitScene& scene, const PatchVisibility& visibility,
                         const IrradianceVolumeOptions& options)
    : scene_(scene), volume_(scene, visibility, options) {}

const DirectionMap& ObjectLight::blurred(int shininess) {
  const auto [at, is_new] = blurred_.try_emplace(shininess);
  // A half vector's lobe of exponent n is about one of n / 4 round the mirror direction.
  if (is_new) at->second = blur(scene_.probe, std::max(1.0, shininess / 4.0));
  return at->second;
}

ObjectRadiance ObjectLight::radiance(std::span<const PlacedObject> objects,
                                     const glm::vec3& eye_world, int threads) {
  ObjectRadiance result(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const PlacedObject& object = objects[i];
    for (std::size_t p = 0; p < object.meshes.size(); ++p) {
      const Mesh& mesh = *object.meshes[p];
      const raster::Material& material = object.object->model->parts[p].material;
      const glm::dvec3 diffuse(linear_color(material.diffuse));
      const glm::dvec3 specular(linear_color(material.specular));
      const bool mirrors = specular != glm::dvec3(0.0) && !scene_.probe.radiance.empty();
      const DirectionMap* probe = mirrors ? &blurred(material.shininess) : nullptr;
      const glm::vec3 emission = linear_color(material.emission);
      const std::size_t base = result[i].size();
      result[i].resize(base + mesh.positions.size());
      raster::for_each_chunk(
          mesh.positions.size(), 128, threads, [&](std::size_t first, std::size_t last) {
            for (std::size_t v = first; v < last; ++v) {
              const glm::dvec3 at(object.object->world_from_model * mesh.positions[v]);
              const glm::dvec3 normal =
                  glm::normalize(glm::dvec3(object.world_from_model_normal * mesh.normals[v]));
              glm::dvec3 light = diffuse * volume_.irradiance(at, normal) / std::numbers::pi;
              if (probe) {
                const glm::dvec3 from = glm::normalize(at - glm::dvec3(eye_world));
                light += specular * glm::dvec3(probe->at(glm::reflect(from, normal)));
              }
              result[i][base + v] = glm::vec3(light) + emission;
            }
          });
    }
  }
  return result;
}

}  // namespace gnomon::pipeline
