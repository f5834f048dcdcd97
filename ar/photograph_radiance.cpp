#include "ar/photograph_radiance.h"

#include <algorithm>
#include <cstdint>

#include "ar/mirror_ball.h"
#include "raster/executor.h"

namespace gnomon::ar {
namespace {

constexpr std::uint32_t kNothing = 0xffffffffu;

std::vector<std::uint32_t> patch_of_pixel(int width, int height, const Lens& lens,
                                          const glm::dmat4& world_from_camera,
                                          const pipeline::PatchVisibility& patches, int threads) {
  std::vector<std::uint32_t> seen(static_cast<std::size_t>(width) * height, kNothing);
  raster::for_each_chunk(
      static_cast<std::size_t>(height), 8, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t y = first; y < last; ++y) {
          for (int x = 0; x < width; ++x) {
            const std::optional<Ray> ray =
                pixel_ray(lens, world_from_camera, glm::dvec2(x, static_cast<double>(y)));
            if (!ray) continue;
            const pipeline::PatchVisibility::Hit hit = patches.trace(ray->origin, ray->direction);
            if (hit.patch != pipeline::PatchVisibility::kNone && hit.front)
              seen[y * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                  static_cast<std::uint32_t>(hit.patch);
          }
        }
      });
  return seen;
}

}  // namespace

PhotographRadiance photograph_radiance(const FloatImage& picture, const Lens& lens,
                                       const glm::dmat4& world_from_camera,
                                       const pipeline::PatchVisibility& patches,
                                       const pipeline::PatchModel& model, int margin_px,
                                       int threads) {
  const int width = picture.width, height = picture.height;
  const std::vector<std::uint32_t> seen =
      patch_of_pixel(width, height, lens, world_from_camera, patches, threads);
  const auto surface = [&](int x, int y) {
    const std::uint32_t patch = seen[static_cast<std::size_t>(y) * width + x];
    return patch == kNothing ? kNothing : model.patches[patch].surface;
  };
  PhotographRadiance result{std::vector<glm::dvec3>(model.patches.size(), glm::dvec3(0.0)),
                            std::vector<std::size_t>(model.patches.size(), 0), 0.0};
  std::size_t beside = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint32_t own = surface(x, y);
      if (own == kNothing) {
        ++beside;
        continue;
      }
      // Four places a margin away stand for all between: a strip thinner than the margin, between
      // equal surfaces, is missed and does not matter to a mean.
      const int left = std::max(0, x - margin_px), right = std::min(width - 1, x + margin_px);
      const int up = std::max(0, y - margin_px), down = std::min(height - 1, y + margin_px);
      if (surface(left, y) != own || surface(right, y) != own || surface(x, up) != own ||
          surface(x, down) != own)
        continue;
      const std::uint32_t patch = seen[static_cast<std::size_t>(y) * width + x];
      const float* value = picture.at(x, y);
      result.radiance[patch] += glm::dvec3(value[0], value[1], value[2]);
      ++result.pixels[patch];
    }
  }
  for (std::size_t p = 0; p < result.radiance.size(); ++p)
    if (result.pixels[p] > 0) result.radiance[p] /= static_cast<double>(result.pixels[p]);
  result.beside = static_cast<double>(beside) / static_cast<double>(seen.size());
  return result;
}

}  // namespace gnomon::ar
