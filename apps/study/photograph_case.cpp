#include "apps/study/photograph_case.h"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "apps/study/bounding_box.h"
#include "apps/study/difference_picture.h"
#include "apps/study/ray_masks.h"
#include "ar/augment.h"
#include "ar/error.h"
#include "ar/flip.h"
#include "ar/metrics.h"
#include "ar/shadow_settings.h"
#include "ar/stopwatch.h"
#include "pipeline/mesh_simplify.h"
#include "pipeline/reduced_occluder.h"

namespace gnomon::apps::study {

using pipeline::Role;
using pipeline::Scene;
using ModelPointer = std::shared_ptr<const pipeline::Model>;

struct PhotographCase::Shared {
  std::string name;
  PlacedPhotograph at;
  RayMasks rays;
  /// Where the true photograph shows a shadow or an object.
  ar::Image region;
};

namespace {

using Shared = PhotographCase::Shared;

/// Another model of a phantom; null takes the phantom away.
using Detail = std::function<ModelPointer(const ModelPointer&)>;

struct Setting {
  std::string name, family;
  ar::AugmentOptions options;
  /// Empty: phantoms are as they are.
  Detail detail;
  std::size_t occluder_triangles = 0;
};

ModelPointer simplified(const ModelPointer& model, double error_m) {
  return std::make_shared<const pipeline::Model>(pipeline::simplify_mesh(*model, error_m).model);
}

Scene with_detail(Scene scene, const Setting& setting) {
  if (setting.detail) {
    for (pipeline::Object& object : scene.objects)
      if (object.role == Role::phantom) object.model = setting.detail(object.model);
    std::erase_if(scene.objects, [](const pipeline::Object& o) { return o.model == nullptr; });
  }
  pipeline::ReducedOccluders(setting.occluder_triangles).apply(scene);
  return scene;
}

ar::AugmentOptions base_options(const ar::SceneFile& file, int threads) {
  return {.extrusion = ar::extrusion(file.shadow.volume),
          .threads = threads,
          .near_m = file.near_m,
          .far_m = file.far_m,
          .masks = false};
}

std::vector<Setting> settings_for(const ar::SceneFile& file, int threads) {
  const ar::AugmentOptions base = base_options(file, threads);
  std::vector<Setting> out;
  const auto add = [&](std::string name, const char* family) -> Setting& {
    return out.emplace_back(Setting{std::move(name), family, base, {}});
  };
  for (const int samples : {1, 2, 4, 8})
    add(fmt::format("automatic, {0}x{0} samples", samples), "samples").options.samples = samples;
  add("z-pass", "volumes").options.method = pipeline::VolumeMethod::zpass;
  add("z-fail", "volumes").options.method = pipeline::VolumeMethod::zfail;
  add("to infinity", "volumes").options.extrusion = {.kind = pipeline::Extrusion::Kind::infinite};
  add("double shadows", "volumes").options.double_shadows = true;
  for (const float radius_m : {2.0f, 0.5f})
    add(fmt::format("volumes of {} m", radius_m), "volumes").options.extrusion = {
        .kind = pipeline::Extrusion::Kind::radius, .radius_m = radius_m};
  for (const double error_m : {0.001, 0.003, 0.01, 0.03})
    add(fmt::format("phantoms within {} mm", 1000.0 * error_m), "phantoms").detail =
        [error_m](const ModelPointer& model) { return simplified(model, error_m); };
  add("phantoms as boxes", "phantoms").detail = [](const ModelPointer& model) {
    return bounding_box(*model);
  };
  add("no phantoms", "phantoms").detail = [](const ModelPointer&) { return ModelPointer(); };
  for (const std::size_t triangles : {500, 100, 20})
    add(fmt::format("casters of {} triangles", triangles), "reduced casters").occluder_triangles =
        triangles;
  return out;
}

/// In percent.
double apart(const ar::Image& mask, const ar::Image& other) {
  return 100.0 * (1.0 - ar::mask_iou(mask, other).value_or(1.0));
}

Charted charted(const Shared& shared, const ar::Image& composite, const ar::Image& shadow_mask) {
  const PlacedPhotograph& at = shared.at;
  Charted out;
  out.point.scene = shared.name;
  out.point.oracle =
      "a photograph of the real thing (which the room's model only comes near to), and Embree rays "
      "with the same model";
  out.point.errors = {
      {"RMSE in the true shadow, of 255",
       ar::difference(composite, at.truth, &*at.shadow_mask).rmse},
      {"FLIP in shadow and objects", ar::mean_error(ar::flip(at.truth, composite), &shared.region)},
      {"shadow mask unlike the true one, % (1 - IoU)", apart(shadow_mask, *at.shadow_mask)},
      {"shadow mask unlike the rays', % (1 - IoU)", apart(shadow_mask, shared.rays.shadow)}};
  out.picture = composite;
  out.difference = difference_picture(at.truth, composite);
  return out;
}

class Volumes final : public Contender {
 public:
  Volumes(const Shared& shared, Setting setting)
      : shared_(shared),
        setting_(std::move(setting)),
        scene_(with_detail(shared.at.scene, setting_)) {}

  Charted measure() override {
    ar::AugmentOptions options = setting_.options;
    options.masks = true;
    ar::Augmenter augmenter(shared_.at.lens, options);
    const ar::Augmented made = draw(augmenter);
    Charted out = charted(shared_, made.composite, made.shadow_mask);
    out.point.family = setting_.family;
    out.point.method = setting_.name;
    return out;
  }
  double frame_ms() override {
    if (!timed_) timed_.emplace(shared_.at.lens, setting_.options);
    ar::Stopwatch watch;
    draw(*timed_);
    return watch.lap_ms();
  }

 private:
  ar::Augmented draw(ar::Augmenter& augmenter) const {
    return augmenter.augment(shared_.at.photograph, scene_, shared_.at.world_from_camera);
  }

  const Shared& shared_;
  Setting setting_;
  Scene scene_;
  std::optional<ar::Augmenter> timed_;
};

/// The photograph as it is.
class Nothing final : public Contender {
 public:
  explicit Nothing(const Shared& shared) : shared_(shared) {}
  Charted measure() override {
    ar::Image none = *shared_.at.shadow_mask;
    std::ranges::fill(none.pixels, std::uint8_t{0});
    Charted out = charted(shared_, shared_.at.photograph, none);
    out.point.family = "nothing";
    out.point.method = "the photograph as it is";
    return out;
  }
  double frame_ms() override {
    ar::Stopwatch watch;
    const ar::Image copy = shared_.at.photograph;
    return copy.pixels.empty() ? 0.0 : watch.lap_ms();
  }

 private:
  const Shared& shared_;
};

ar::Image united(const ar::Image& a, const std::optional<ar::Image>& b) {
  ar::Image out{a.width, a.height, 1, {}};
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      out.pixels.push_back(ar::picked(&a, x, y) || (b && ar::picked(&*b, x, y)) ? 255 : 0);
  return out;
}

}  // namespace

PhotographCase::PhotographCase(StudyPhotograph photograph, int threads)
    : photograph_(std::move(photograph)), threads_(threads) {}
PhotographCase::~PhotographCase() = default;

std::vector<std::unique_ptr<Contender>> PhotographCase::contenders() {
  if (!shared_) {
    PlacedPhotograph at = place(photograph_, threads_);
    const std::string scene = photograph_.scene.string();
    if (at.scene.lights.size() != 1) throw ar::InputError(scene + ": one light can be charted");
    if (!at.shadow_mask) throw ar::InputError(photograph_.name + ": shadow_mask: missing");
    if (std::ranges::none_of(at.shadow_mask->pixels, [](int v) { return v >= ar::kMaskThreshold; }))
      throw ar::InputError(photograph_.name + ": shadow_mask: no pixel is in it");
    RayMasks rays = ray_masks(at.scene, at.lens, at.world_from_camera, threads_);
    ar::Image region = united(*at.shadow_mask, at.object_mask);
    shared_ =
        std::make_unique<Shared>(Shared{name(), std::move(at), std::move(rays), std::move(region)});
  }
  std::vector<std::unique_ptr<Contender>> out;
  for (Setting& setting : settings_for(shared_->at.file, threads_))
    out.push_back(std::make_unique<Volumes>(*shared_, std::move(setting)));
  out.push_back(std::make_unique<Nothing>(*shared_));
  return out;
}

}  // namespace gnomon::apps::study
