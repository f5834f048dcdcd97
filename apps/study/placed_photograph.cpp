#include "apps/study/placed_photograph.h"

#include <filesystem>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"
#include "ar/session.h"
#include "ar/session_options.h"

namespace gnomon::apps::study {

namespace fs = std::filesystem;

namespace {

ar::Image read_like(const fs::path& file, const ar::Image& photograph, bool mask) {
  ar::Image image = mask ? ar::read_image(file) : ar::read_image_rgb(file);
  if (image.width != photograph.width || image.height != photograph.height)
    throw ar::InputError(fmt::format("{}: {}x{} pixels, and the photograph has {}x{}",
                                     ar::one_line(file.string()), image.width, image.height,
                                     photograph.width, photograph.height));
  return image;
}

std::optional<ar::Image> read_mask(const fs::path& file, const ar::Image& photograph) {
  if (file.empty()) return std::nullopt;
  return read_like(file, photograph, true);
}

}  // namespace

PlacedPhotograph place(const StudyPhotograph& photograph, int threads) {
  ar::SceneFile file = ar::read_scene(photograph.scene);
  ar::Image photo = ar::read_image_rgb(photograph.photograph);
  // Volumes need no captured light, and only the places are wanted.
  ar::Session session(file, photo.width, photo.height,
                      {.method = pipeline::VolumeMethod::automatic,
                       .still = true,
                       .samples = 1,
                       .threads = threads,
                       .masks = false});
  ar::SessionResult result = session.process(photo, 0.0);
  if (!result.world_from_camera || !result.left_out.empty())
    throw ar::InputError(fmt::format("{}: the tags of {} are not all found in it",
                                     ar::one_line(photograph.photograph.string()),
                                     ar::one_line(photograph.scene.string())));
  ar::Lens lens(ar::photograph_camera(file, photo.width, photo.height));
  return {.file = std::move(file),
          .lens = std::move(lens),
          .photograph = photo,
          .truth = read_like(photograph.truth, photo, false),
          .shadow_mask = read_mask(photograph.shadow_mask, photo),
          .object_mask = read_mask(photograph.object_mask, photo),
          .world_from_camera = *result.world_from_camera,
          .scene = std::move(result.scene)};
}

}  // namespace gnomon::apps::study
