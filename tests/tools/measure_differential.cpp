// Differential shadows against photographs of the real thing, and against rays.
// Usage: measure_differential LIT_SCENE CAPTURE TRUTH [OUT]   where CAPTURE has background.png,
// camera.yml and camera_pose.json, TRUTH a folder for each photograph with photo.png, pose.json and
// object_mask.png; models are looked for beside CAPTURE's own. Pictures go to OUT; references that
// lie there already (NAME_reference.png) are read and not made again.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "ar/camera.h"
#include "ar/differential_augment.h"
#include "ar/flip.h"
#include "ar/image_file.h"
#include "ar/lit_scene_file.h"
#include "ar/model_file.h"
#include "ar/stopwatch.h"
#include "capture_json.h"
#include "pipeline/differential_reference.h"
#include "statistics.h"

namespace gnomon::ar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using pipeline::ShadowMask;
using pipeline::ShadowPrecision;

struct Truth {
  std::string name;
  Image photo, object_mask;
  pipeline::Scene scene;
};

struct Capture {
  std::shared_ptr<const pipeline::LitScene> lit;
  CameraModel camera;
  glm::dmat4 world_from_camera{1.0};
  Image background;
  std::vector<Truth> truths;
};

Capture read(const fs::path& lit, const fs::path& capture, const fs::path& truth) {
  Capture out;
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
    const json pose = load_json(folder / "pose.json");
    for (const json& object : pose.at("objects")) {
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

std::vector<pipeline::Ray> photo_rays(const Capture& capture) {
  const Lens lens(capture.camera);
  std::vector<pipeline::Ray> rays;
  for (int y = 0; y < capture.background.height; ++y) {
    for (int x = 0; x < capture.background.width; ++x) {
      const auto at = lens.undistort({x, y});
      const glm::dvec3 direction(at.value_or(glm::dvec2(0.0)), 1.0);
      rays.push_back({glm::dvec3(capture.world_from_camera[3]),
                      glm::dmat3(capture.world_from_camera) * direction});
    }
  }
  return rays;
}

/// Pixels in the shadow: the reference takes something there, and no virtual object touches them in
/// photograph or model.
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

/// Mean darkening, in values.
double strength(const std::vector<std::uint8_t>& background, const std::vector<std::uint8_t>& a,
                const std::vector<std::size_t>& region) {
  double sum = 0.0;
  for (const std::size_t i : region) {
    for (std::size_t c = 0; c < 3; ++c)
      sum += static_cast<double>(background[3 * i + c]) - a[3 * i + c];
  }
  return region.empty() ? 0.0 : sum / (3.0 * static_cast<double>(region.size()));
}

struct Setting {
  std::string name;
  DifferentialSettings settings;
};

DifferentialSettings setting(std::size_t passes, ShadowPrecision precision,
                             ShadowMask mask = ShadowMask::map) {
  DifferentialSettings out;
  out.method.take.passes = passes;
  out.method.take.precision = precision;
  out.method.mask = mask;
  return out;
}

std::vector<Setting> settings() {
  constexpr std::size_t kAll = 1'000'000;
  std::vector<Setting> out;
  for (const std::size_t n : {std::size_t{5}, std::size_t{10}, std::size_t{20}, std::size_t{50},
                              std::size_t{100}, kAll}) {
    out.push_back({n == kAll ? "all" : std::to_string(n), setting(n, ShadowPrecision::bytes)});
  }
  out.push_back({"50 dithered", setting(50, ShadowPrecision::dithered)});
  out.push_back({"50 values", setting(50, ShadowPrecision::values)});
  out.push_back({"50 radiance", setting(50, ShadowPrecision::radiance)});
  out.push_back({"all dithered", setting(kAll, ShadowPrecision::dithered)});
  out.push_back({"all radiance", setting(kAll, ShadowPrecision::radiance)});
  out.push_back({"50 volumes", setting(50, ShadowPrecision::bytes, ShadowMask::volumes)});
  out.push_back({"50 whole clusters", setting(50, ShadowPrecision::bytes)});
  out.back().settings.method.take.whole_clusters = true;
  out.push_back({"50 pruned (paper)", setting(50, ShadowPrecision::bytes)});
  out.back().settings.light.drop_pruned = true;
  out.push_back({"all, all power, radiance", setting(kAll, ShadowPrecision::radiance)});
  out.back().settings.light.transfer.power_share = 1.0;
  return out;
}

double median_ms(DifferentialAugmenter& augmenter, const Image& background,
                 const pipeline::Scene& scene, const glm::dmat4& pose, double& record_ms,
                 double& execute_ms) {
  std::vector<double> whole, record, execute;
  for (int i = 0; i < 11; ++i) {
    Stopwatch watch;
    const Augmented out = augmenter.augment(background, scene, pose);
    whole.push_back(watch.lap_ms());
    record.push_back(out.record_ms);
    execute.push_back(out.execute_ms);
  }
  for (auto* list : {&whole, &record, &execute}) std::sort(list->begin(), list->end());
  record_ms = record[5];
  execute_ms = execute[5];
  return whole[5];
}

/// The picture, and as its mask's channels: object, shadow.
pipeline::ReferencePicture reference_of(const Capture& capture, const Truth& truth,
                                        const std::vector<pipeline::Ray>& rays,
                                        const fs::path& out) {
  const fs::path file = out / (truth.name + "_reference.png");
  const fs::path mask_file = out / (truth.name + "_reference_mask.png");
  if (!out.empty() && fs::exists(file) && fs::exists(mask_file)) {
    pipeline::ReferencePicture known{read_image_rgb(file).pixels, {}, {}};
    const Image mask = read_image_rgb(mask_file);
    for (std::size_t i = 0; i < mask.pixels.size(); i += 3) {
      known.object.push_back(mask.pixels[i] != 0 ? 1 : 0);
      known.shadow.push_back(mask.pixels[i + 1] != 0 ? 1 : 0);
    }
    return known;
  }
  const pipeline::DifferentialReference reference(*capture.lit, truth.scene);
  pipeline::ReferencePicture made = reference.render(rays, capture.background.pixels, {});
  if (out.empty()) return made;
  Image picture = capture.background, mask = capture.background;
  picture.pixels = made.pixels;
  for (std::size_t i = 0; i < made.object.size(); ++i) {
    mask.pixels[3 * i] = made.object[i] ? 255 : 0;
    mask.pixels[3 * i + 1] = made.shadow[i] ? 255 : 0;
    mask.pixels[3 * i + 2] = 0;
  }
  write_png(file, picture);
  write_png(mask_file, mask);
  return made;
}

void measure(const Capture& capture, const fs::path& out) {
  const std::vector<pipeline::Ray> rays = photo_rays(capture);
  const Image& background = capture.background;
  std::vector<pipeline::ReferencePicture> references;
  std::vector<std::vector<std::size_t>> regions;
  fmt::print("reference and photographs (values of 255; 1 - RMSE / RMSE without a shadow)\n");
  fmt::print(
      "| photograph | pixels | RMSE without | reference | 1 - ratio | darker, photograph | "
      "reference | s |\n");
  for (const Truth& truth : capture.truths) {
    Stopwatch watch;
    references.push_back(reference_of(capture, truth, rays, out));
    const double seconds = watch.lap_ms() / 1000.0;
    regions.push_back(shadow_region(truth, references.back(), background));
    const auto& region = regions.back();
    const double without = rmse(background.pixels, truth.photo.pixels, region);
    const double with = rmse(references.back().pixels, truth.photo.pixels, region);
    fmt::print("| {} | {} | {:.2f} | {:.2f} | {:.3f} | {:.2f} | {:.2f} | {:.1f} |\n", truth.name,
               region.size(), without, with, 1.0 - with / without,
               strength(background.pixels, truth.photo.pixels, region),
               strength(background.pixels, references.back().pixels, region), seconds);
    std::fflush(stdout);
  }
  const Lens lens(capture.camera);
  fmt::print(
      "\n| n | photograph | sources | shadows | 1 - ratio | reference's | RMSE to reference "
      "| darker | whole ms | record | execute |\n");
  for (const Setting& one : settings()) {
    Stopwatch watch;
    DifferentialAugmenter augmenter(lens, capture.lit, capture.world_from_camera, one.settings);
    const double setup_ms = watch.lap_ms();
    const pipeline::LightPaths& paths = augmenter.paths();
    fmt::print("{}: {} sources, {} leaf shafts, {} pruned, {:.0f} ms before the first frame\n",
               one.name, paths.transfers.sources.size(), paths.leaf_shafts, paths.pruned_shafts,
               setup_ms);
    double sum = 0.0, sum_reference = 0.0;
    for (std::size_t t = 0; t < capture.truths.size(); ++t) {
      const Truth& truth = capture.truths[t];
      const Augmented picture =
          augmenter.augment(background, truth.scene, capture.world_from_camera);
      const double without = rmse(background.pixels, truth.photo.pixels, regions[t]);
      const double ratio =
          1.0 - rmse(picture.composite.pixels, truth.photo.pixels, regions[t]) / without;
      const double ratio_reference =
          1.0 - rmse(references[t].pixels, truth.photo.pixels, regions[t]) / without;
      sum += ratio;
      sum_reference += ratio_reference;
      double record_ms = 0.0, execute_ms = 0.0;
      const double ms = median_ms(augmenter, background, truth.scene, capture.world_from_camera,
                                  record_ms, execute_ms);
      fmt::print(
          "| {} | {} | {} | {} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.1f} | {:.1f} | {:.1f} "
          "|\n",
          one.name, truth.name, augmenter.report().occluded_sources, augmenter.report().shadows,
          ratio, ratio_reference, rmse(picture.composite.pixels, references[t].pixels, regions[t]),
          strength(background.pixels, picture.composite.pixels, regions[t]), ms, record_ms,
          execute_ms);
      std::fflush(stdout);
      if (!out.empty()) write_png(out / (truth.name + "_" + one.name + ".png"), picture.composite);
    }
    fmt::print("mean of {}: {:.3f}, of the reference {:.3f}\n", one.name,
               sum / static_cast<double>(capture.truths.size()),
               sum_reference / static_cast<double>(capture.truths.size()));
  }
}

}  // namespace
}  // namespace gnomon::ar

int main(int argc, char** argv) {
  try {
    if (argc < 4 || argc > 5)
      throw std::runtime_error("usage: measure_differential LIT_SCENE CAPTURE TRUTH [OUT]");
    const std::filesystem::path out = argc == 5 ? argv[4] : "";
    if (!out.empty()) std::filesystem::create_directories(out);
    gnomon::ar::measure(gnomon::ar::read(argv[1], argv[2], argv[3]), out);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measure_differential: %s\n", error.what());
    return 1;
  }
}
