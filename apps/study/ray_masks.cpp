#include "apps/study/ray_masks.h"

#include "raster/executor.h"

namespace gnomon::apps::study {

using pipeline::Among;

namespace {

/// Far above everything, and upwards.
const pipeline::Ray kToNothing{glm::dvec3(0.0, 1e9, 0.0), glm::dvec3(0.0, 1.0, 0.0)};

ar::Image empty_mask(const ar::CameraModel& camera) {
  return {camera.width, camera.height, 1,
          std::vector<std::uint8_t>(static_cast<std::size_t>(camera.width) * camera.height)};
}

/// Of the pixel with that number.
void cast(const pipeline::RayReference& rays, const pipeline::Scene& scene,
          const pipeline::Ray& ray, std::size_t pixel, RayMasks& masks) {
  const pipeline::RayHit hit = rays.trace(ray);
  if (!hit.hit) return;
  const glm::vec4 light = scene.lights.at(0).position;
  const auto by_real = rays.shadow(hit, light, Among::phantoms);
  const auto by_virtual = rays.shadow(hit, light, Among::virtual_objects);
  if (scene.objects[hit.object].role == pipeline::Role::virtual_object) {
    masks.object.pixels[pixel] = 255;
    if (by_real.blocked && !by_virtual.in_shadow) masks.shadow_on_virtual.pixels[pixel] = 255;
  } else if (!by_real.in_shadow && by_virtual.blocked) {
    masks.shadow.pixels[pixel] = 255;
  }
}

}  // namespace

std::vector<pipeline::Ray> lens_rays(const ar::Lens& lens, const glm::dmat4& world_from_camera) {
  std::vector<pipeline::Ray> rays;
  const glm::dvec3 eye(world_from_camera[3]);
  for (int y = 0; y < lens.camera().height; ++y) {
    for (int x = 0; x < lens.camera().width; ++x) {
      if (const auto at = lens.undistort({x, y}))
        rays.push_back({eye, glm::dmat3(world_from_camera) * glm::dvec3(*at, 1.0)});
      else
        rays.push_back(kToNothing);
    }
  }
  return rays;
}

RayMasks ray_masks(const pipeline::Scene& scene, const ar::Lens& lens,
                   const glm::dmat4& world_from_camera, int threads) {
  const pipeline::RayReference reference(scene);
  const std::vector<pipeline::Ray> rays = lens_rays(lens, world_from_camera);
  RayMasks masks{empty_mask(lens.camera()), empty_mask(lens.camera()), empty_mask(lens.camera())};
  constexpr std::size_t kChunk = 4096;
  raster::for_each_chunk(rays.size(), kChunk, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) cast(reference, scene, rays[i], i, masks);
  });
  return masks;
}

}  // namespace gnomon::apps::study
