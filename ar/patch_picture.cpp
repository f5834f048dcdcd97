#include "ar/patch_picture.h"

#include <cmath>

#include "ar/mirror_ball.h"
#include "pipeline/patch_light.h"
#include "raster/executor.h"

namespace gnomon::ar {

Image patch_picture(const pipeline::LitScene& scene, const CameraModel& camera,
                    const glm::dmat4& world_from_camera, int threads) {
  const Lens lens(camera);
  const pipeline::PatchVisibility patches(scene.model);
  Image picture{camera.width, camera.height, 3, {}};
  picture.pixels.assign(static_cast<std::size_t>(camera.width) * camera.height * 3, 0);
  raster::for_each_chunk(static_cast<std::size_t>(camera.height), 8, threads,
                         [&](std::size_t first, std::size_t last) {
                           for (std::size_t y = first; y < last; ++y) {
                             for (int x = 0; x < camera.width; ++x) {
                               const std::optional<Ray> ray = pixel_ray(
                                   lens, world_from_camera, glm::dvec2(x, static_cast<double>(y)));
                               if (!ray) continue;
                               const auto hit = patches.trace(ray->origin, ray->direction);
                               if (hit.patch == pipeline::PatchVisibility::kNone || !hit.front)
                                 continue;
                               const glm::dvec3 value =
                                   scene.tone.value(glm::dvec3(scene.radiance[hit.patch]));
                               for (int c = 0; c < 3; ++c)
                                 picture.at(x, static_cast<int>(y))[c] =
                                     static_cast<std::uint8_t>(std::lround(value[c]));
                             }
                           }
                         });
  return picture;
}

}  // namespace gnomon::ar
