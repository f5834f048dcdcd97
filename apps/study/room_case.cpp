#include "apps/study/room_case.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "apps/study/difference_picture.h"
#include "apps/study/placed_photograph.h"
#include "apps/study/ray_masks.h"
#include "ar/error.h"
#include "ar/flip.h"
#include "ar/metrics.h"
#include "ar/stopwatch.h"
#include "pipeline/differential_reference.h"

namespace gnomon::apps::study {

namespace {

constexpr int kSamples = 16;

}  // namespace

struct RoomCase::Shared {
  std::string name;
  PlacedPhotograph at;
  CapturedRoom& room;
  pipeline::DifferentialReference reference;
  std::vector<pipeline::Ray> rays;
  /// By kSamples points a patch.
  ar::Image by_rays;
  /// Of the shadow: `by_rays` takes two values or more in some channel, and no virtual object
  /// touches the pixel.
  ar::Image region;
  int threads;

  pipeline::ReferencePicture cast(int samples) const {
    return reference.render(rays, at.photograph.pixels,
                            {.samples = samples, .object_samples = 4, .threads = threads});
  }
  ar::Image picture(std::vector<std::uint8_t> pixels) const {
    return {at.photograph.width, at.photograph.height, 3, std::move(pixels)};
  }
};

namespace {

using Shared = RoomCase::Shared;

Charted charted(const Shared& shared, const ar::Image& composite, std::string family,
                std::string method) {
  Charted out;
  out.point.scene = shared.name;
  out.point.family = std::move(family);
  out.point.method = std::move(method);
  out.point.oracle = "a photograph of the real thing, and rays to all patches of the same light";
  out.point.errors = {
      {"RMSE in the shadow, of 255",
       ar::difference(composite, shared.at.truth, &shared.region).rmse},
      {"FLIP in the shadow", ar::mean_error(ar::flip(shared.at.truth, composite), &shared.region)},
      {"RMSE to the rays' picture, of 255",
       ar::difference(composite, shared.by_rays, &shared.region).rmse}};
  out.picture = composite;
  out.difference = difference_picture(shared.at.truth, composite);
  return out;
}

class Differential final : public Contender {
 public:
  Differential(const Shared& shared, DifferentialSetting setting)
      : shared_(shared), setting_(std::move(setting)) {}
  Charted measure() override {
    return charted(shared_, draw().composite, setting_.family, setting_.name);
  }
  double frame_ms() override {
    ar::Stopwatch watch;
    draw();
    return watch.lap_ms();
  }

 private:
  ar::Augmented draw() {
    const PlacedPhotograph& at = shared_.at;
    return shared_.room.augmenter(setting_, at)
        .augment(at.photograph, at.scene, at.world_from_camera);
  }

  const Shared& shared_;
  DifferentialSetting setting_;
};

class Rays final : public Contender {
 public:
  Rays(const Shared& shared, int samples) : shared_(shared), samples_(samples) {}
  Charted measure() override {
    return charted(
        shared_,
        samples_ == kSamples ? shared_.by_rays : shared_.picture(shared_.cast(samples_).pixels),
        "rays", fmt::format("Embree rays, {} a patch", samples_));
  }
  double frame_ms() override {
    ar::Stopwatch watch;
    shared_.cast(samples_);
    return watch.lap_ms();
  }

 private:
  const Shared& shared_;
  int samples_;
};

/// The photograph as it is.
class Nothing final : public Contender {
 public:
  explicit Nothing(const Shared& shared) : shared_(shared) {}
  Charted measure() override {
    return charted(shared_, shared_.at.photograph, "nothing", "the photograph as it is");
  }
  double frame_ms() override {
    ar::Stopwatch watch;
    const ar::Image copy = shared_.at.photograph;
    return copy.pixels.empty() ? 0.0 : watch.lap_ms();
  }

 private:
  const Shared& shared_;
};

ar::Image shadow_region(const Shared& shared, const pipeline::ReferencePicture& cast) {
  constexpr int kTaken = 2;
  const ar::Image& photograph = shared.at.photograph;
  const auto& object_mask = shared.at.object_mask;
  ar::Image region{photograph.width, photograph.height, 1, {}};
  for (std::size_t i = 0; i < cast.shadow.size(); ++i) {
    int taken = 0;
    for (std::size_t c = 0; c < 3; ++c)
      taken = std::max(taken, photograph.pixels[3 * i + c] - cast.pixels[3 * i + c]);
    const bool object =
        cast.object[i] != 0 ||
        (object_mask && object_mask->pixels[i * static_cast<std::size_t>(object_mask->channels)]);
    region.pixels.push_back(!object && taken >= kTaken ? 255 : 0);
  }
  return region;
}

}  // namespace

RoomCase::RoomCase(StudyPhotograph photograph, CapturedRooms& rooms, int threads)
    : photograph_(std::move(photograph)), rooms_(rooms), threads_(threads) {}
RoomCase::~RoomCase() = default;

std::vector<std::unique_ptr<Contender>> RoomCase::contenders() {
  if (!shared_) {
    PlacedPhotograph at = place(photograph_, threads_);
    CapturedRoom& room = rooms_.room(photograph_.capture);
    std::vector<pipeline::Ray> rays = lens_rays(at.lens, at.world_from_camera);
    const pipeline::Scene scene = ar::virtual_ones(at.scene);
    shared_.reset(new Shared{
        name(), std::move(at), room, {*room.light(), scene}, std::move(rays), {}, {}, threads_});
    const pipeline::ReferencePicture cast = shared_->cast(kSamples);
    shared_->by_rays = shared_->picture(cast.pixels);
    shared_->region = shadow_region(*shared_, cast);
    if (std::ranges::count(shared_->region.pixels, 255) == 0)
      throw ar::InputError(photograph_.name + ": no shadow falls on what the photograph shows");
  }
  std::vector<std::unique_ptr<Contender>> out;
  for (DifferentialSetting& setting : differential_settings())
    out.push_back(std::make_unique<Differential>(*shared_, std::move(setting)));
  for (const int samples : {1, 4, kSamples})
    out.push_back(std::make_unique<Rays>(*shared_, samples));
  out.push_back(std::make_unique<Nothing>(*shared_));
  return out;
}

}  // namespace gnomon::apps::study
