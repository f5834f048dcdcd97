// Views that are photographs: by volumes, or by differential shadows.
#include <algorithm>
#include <array>
#include <memory>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/fit_drawing.h"
#include "ar/lit_scene_file.h"
#include "ar/session.h"
#include "ar/session_options.h"

namespace gnomon::ar {

namespace {

/// Light enough that a shadow has many steps below it, and a gleam some above.
constexpr std::uint8_t kGrey = 192;

struct View {
  Image photograph, grey;
  Lens lens;
  glm::dmat4 world_from_camera{1.0};
  pipeline::Scene placed;
};

double milliseconds(const Augmented& drawn) {
  return drawn.resample_ms + drawn.record_ms + drawn.execute_ms + drawn.composite_ms;
}

View place(const SceneFile& file, NamedPicture photograph, int threads) {
  const int width = photograph.picture.width, height = photograph.picture.height;
  SessionOptions options{.still = true, .threads = threads, .masks = false};
  // Poses are wanted, not the picture; a scene without lights can be drawn by volumes too.
  options.method = pipeline::VolumeMethod::automatic;
  options.samples = 1;
  Session session(file, width, height, options);
  SessionResult result = session.process(photograph.picture, 0.0);
  if (!result.augmented)
    throw InputError(fmt::format(
        "{}: no pose for any virtual object: {} tags found, none of the scene's that "
        "are needed ({})",
        one_line(photograph.name), result.track.detections.size(), session.known_tags()));
  Image grey{width, height, 3, {}};
  grey.pixels.assign(photograph.picture.pixels.size(), kGrey);
  return {std::move(photograph.picture), std::move(grey),
          Lens(photograph_camera(file, width, height)), *result.world_from_camera,
          std::move(result.scene)};
}

class Photographs : public FitDrawing {
 public:
  Photographs(const SceneFile& file, std::vector<NamedPicture> photographs, int threads)
      : threads_(threads) {
    for (NamedPicture& photograph : photographs)
      views_.push_back(place(file, std::move(photograph), threads));
    for (const View& view : views_)
      for (const pipeline::Object& object : view.placed.objects) placed_.insert(object.name);
  }

  FitPictures draw(const FitScene& scene) override {
    FitPictures out;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      Augmented drawn = augment(i, views_[i].grey, scene, out);
      out.ms += milliseconds(drawn);
      out.pictures.push_back(std::move(drawn.composite));
    }
    return out;
  }

  std::vector<Image> untouched(const FitScene&) override {
    std::vector<Image> pictures;
    for (const View& view : views_) pictures.push_back(view.grey);
    return pictures;
  }

  Image show(const FitScene& scene) override {
    FitPictures unused;
    return augment(0, views_[0].photograph, scene, unused).composite;
  }

  const std::set<std::string>& placed() const override { return placed_; }

 protected:
  virtual Augmented augment(std::size_t view, const Image& picture, const FitScene& scene,
                            FitPictures& out) = 0;
  const View& view(std::size_t i) const { return views_[i]; }
  std::size_t view_count() const { return views_.size(); }
  int threads() const { return threads_; }

 private:
  int threads_;
  std::vector<View> views_;
  std::set<std::string> placed_;
};

/// The two last of a kind that were made, since scenes are timed in turns.
template <class Key, class Made>
class LastTwo {
 public:
  template <class Make>
  Made& get(const Key& key, const Make& make) {
    if (!entries_[0].made || entries_[0].key != key) std::swap(entries_[0], entries_[1]);
    if (!entries_[0].made || entries_[0].key != key) {
      entries_[0].made.reset();
      entries_[0].made = std::make_unique<Made>(make());
      entries_[0].key = key;
    }
    return *entries_[0].made;
  }

 private:
  struct Entry {
    Key key{};
    std::unique_ptr<Made> made;
  };
  std::array<Entry, 2> entries_;
};

class ByVolumes : public Photographs {
 public:
  using Photographs::Photographs;

 private:
  /// What an augmenter is made with.
  using Key = std::tuple<int, pipeline::VolumeMethod, pipeline::Extrusion::Kind, float>;

  Augmented augment(std::size_t i, const Image& picture, const FitScene& scene,
                    FitPictures&) override {
    const AugmentOptions options =
        augment_options(scene.file, {.threads = threads(), .masks = false});
    const Key key{options.samples, options.method, options.extrusion.kind,
                  options.extrusion.radius_m};
    augmenters_.resize(view_count());
    Augmenter& augmenter =
        augmenters_[i].get(key, [&] { return Augmenter(view(i).lens, options); });
    return augmenter.augment(picture, with_fit(view(i).placed, scene), view(i).world_from_camera);
  }

  std::vector<LastTwo<Key, Augmenter>> augmenters_;
};

class ByDifference : public Photographs {
 public:
  ByDifference(const SceneFile& file, std::vector<NamedPicture> photographs,
               std::filesystem::path lit_scene, int threads)
      : Photographs(file, std::move(photographs), threads), options_({.still = true}) {
    options_.lit_scene = std::move(lit_scene);
    options_.threads = threads;
    options_.masks = false;
    lit_ = std::make_shared<const pipeline::LitScene>(
        read_lit_scene(differential_file(file, options_)->lit_scene));
  }

 private:
  /// What an augmenter is made with; it can be told another number of passes.
  using Key = std::tuple<int, double, double, std::size_t, pipeline::ShadowPrecision,
                         pipeline::ShadowMask, int, bool>;

  Augmented augment(std::size_t i, const Image& picture, const FitScene& scene,
                    FitPictures& out) override {
    const DifferentialSettings s = differential_file(scene.file, options_)->settings;
    const Key key{s.samples,
                  s.light.transfer.power_share,
                  s.light.prune_share,
                  s.occluder_triangles,
                  s.method.take.precision,
                  s.method.mask,
                  s.method.map_size,
                  s.method.self_shadows};
    augmenters_.resize(view_count());
    DifferentialAugmenter& augmenter = augmenters_[i].get(key, [&] {
      return DifferentialAugmenter(view(i).lens, lit_, view(i).world_from_camera, s);
    });
    augmenter.set_passes(s.method.take.passes);
    Augmented drawn =
        augmenter.augment(picture, with_fit(view(i).placed, scene), view(i).world_from_camera);
    out.passes = std::max(out.passes, augmenter.report().shadows);
    return drawn;
  }

  SessionOptions options_;
  std::shared_ptr<const pipeline::LitScene> lit_;
  std::vector<LastTwo<Key, DifferentialAugmenter>> augmenters_;
};

}  // namespace

std::unique_ptr<FitDrawing> draw_in_photographs(const SceneFile& file,
                                                std::vector<NamedPicture> photographs,
                                                const std::filesystem::path& lit_scene,
                                                int threads) {
  if (file.differential)
    return std::make_unique<ByDifference>(file, std::move(photographs), lit_scene, threads);
  return std::make_unique<ByVolumes>(file, std::move(photographs), threads);
}

}  // namespace gnomon::ar
