#include "differential_truth.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/study/ray_masks.h"
#include "ar/image_file.h"
#include "ar/lit_scene_file.h"
#include "ar/model_file.h"
#include "capture_json.h"

namespace gnomon::ar {

namespace fs = std::filesystem;

TruthSet read_truths(const fs::path& lit, const fs::path& capture, const fs::path& truth) {
  TruthSet out;
  out.lit = std::make_shared<const pipeline::LitScene>(read_lit_scene(lit));
  out.background = read_image_rgb(capture / "background.png");
  out.camera = camera_for_picture(read_camera(capture / "camera.yml"), out.background.width,
                                  out.background.height);
  out.world_from_camera =
      matrix_of(load_json(capture / "camera_pose.json").at("world_from_camera_opencv"));
  std::set<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(truth)) {
    if (entry.is_directory()) folders.insert(entry.path());
  }
  for (const fs::path& folder : folders) {
    Truth one{folder.filename().string(),
              read_image_rgb(folder / "photo.png"),
              read_image(folder / "object_mask.png"),
              {}};
    const nlohmann::json pose = load_json(folder / "pose.json");
    for (const nlohmann::json& object : pose.at("objects")) {
      const std::string model = object.at("model").get<std::string>();
      one.scene.objects.push_back(
          {.name = model,
           .model = std::make_shared<const pipeline::Model>(load_model(capture / model).model),
           .world_from_model = glm::mat4(matrix_of(object.at("world_from_object")))});
    }
    out.truths.push_back(std::move(one));
  }
  return out;
}

std::vector<pipeline::Ray> photo_rays(const TruthSet& set) {
  return apps::study::lens_rays(Lens(set.camera), set.world_from_camera);
}

namespace {

/// As a mask's channels: object, shadow.
Image mask_of(const pipeline::ReferencePicture& made, int width, int height) {
  Image mask{width, height, 3, {}};
  for (std::size_t i = 0; i < made.object.size(); ++i) {
    for (const std::uint8_t set : {made.object[i], made.shadow[i], std::uint8_t{0}})
      mask.pixels.push_back(set ? 255 : 0);
  }
  return mask;
}

}  // namespace

pipeline::ReferencePicture reference_of(const TruthSet& set, const Truth& truth,
                                        const std::vector<pipeline::Ray>& rays,
                                        const fs::path& folder) {
  const fs::path file = folder / (truth.name + "_reference.png");
  const fs::path mask_file = folder / (truth.name + "_reference_mask.png");
  if (!folder.empty() && fs::exists(file) && fs::exists(mask_file)) {
    pipeline::ReferencePicture known{read_image_rgb(file).pixels, {}, {}};
    const Image mask = read_image_rgb(mask_file);
    for (std::size_t i = 0; i < mask.pixels.size(); i += 3) {
      known.object.push_back(mask.pixels[i] != 0 ? 1 : 0);
      known.shadow.push_back(mask.pixels[i + 1] != 0 ? 1 : 0);
    }
    return known;
  }
  const pipeline::DifferentialReference reference(*set.lit, truth.scene);
  pipeline::ReferencePicture made = reference.render(rays, set.background.pixels, {});
  if (folder.empty()) return made;
  Image picture = set.background;
  picture.pixels = made.pixels;
  write_png(file, picture);
  write_png(mask_file, mask_of(made, picture.width, picture.height));
  return made;
}

std::vector<std::size_t> shadow_region(const Truth& truth,
                                       const pipeline::ReferencePicture& reference,
                                       const Image& background) {
  std::vector<std::size_t> region;
  for (std::size_t i = 0; i < reference.shadow.size(); ++i) {
    const bool object =
        reference.object[i] || truth.object_mask.pixels[i * truth.object_mask.channels] != 0;
    int taken = 0;
    for (std::size_t c = 0; c < 3; ++c)
      taken = std::max(taken, background.pixels[3 * i + c] - reference.pixels[3 * i + c]);
    if (!object && taken >= 2) region.push_back(i);
  }
  return region;
}

double rmse(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
            const std::vector<std::size_t>& region) {
  double sum = 0.0;
  for (const std::size_t i : region) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = static_cast<double>(a[3 * i + c]) - b[3 * i + c];
      sum += d * d;
    }
  }
  return region.empty() ? 0.0 : std::sqrt(sum / (3.0 * static_cast<double>(region.size())));
}

double mean_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                       const std::vector<std::size_t>& region) {
  double sum = 0.0;
  for (const std::size_t i : region) {
    for (std::size_t c = 0; c < 3; ++c) sum += static_cast<double>(a[3 * i + c]) - b[3 * i + c];
  }
  return region.empty() ? 0.0 : sum / (3.0 * static_cast<double>(region.size()));
}

}  // namespace gnomon::ar
