#include "ar/scene_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ar/brackets.h"
#include "ar/capture_model.h"
#include "ar/error.h"
#include "ar/image_file.h"
#include "ar/median.h"
#include "ar/merge_radiance.h"
#include "ar/patch_balance.h"
#include "ar/photograph_radiance.h"
#include "ar/pixel_footprints.h"
#include "ar/probe_map.h"
#include "ar/response_fit.h"
#include "ar/share_radiance.h"
#include "ar/stopwatch.h"
#include "ar/sun_light.h"
#include "pipeline/sun.h"

namespace gnomon::ar {
namespace {

/// So many pixels of the photograph say more about a patch than the probe's fewer, coarser ones.
constexpr std::size_t kLeastPhotographPixels = 16;
/// Of the photograph: models are off by about a centimetre, a few pixels at a few metres.
constexpr int kMarginPx = 3;
/// What a patch needs in a probe's picture, in pixels.
constexpr double kLeastProbePixels = 0.25;
/// Of a ball's picture: pixels so near to the rim see past it.
constexpr double kRimPx = 1.5;
/// Median difference of the photograph from its brackets, in pixel values, that means another
/// exposure time and not noise.
constexpr double kOtherTime = 12.0;

void scale(FloatImage& picture, const glm::dvec3& factor) {
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    picture.pixels[i] = static_cast<float>(static_cast<double>(picture.pixels[i]) *
                                           factor[static_cast<int>(i % 3)]);
}

pipeline::ToneCurve tone_of(const ExposureCurve& curve) {
  pipeline::ToneCurve tone;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t v = 0; v < 256; ++v)
      tone.radiance_from_value[c][v] = static_cast<float>(curve.exposure_from_value[c][v]);
  return tone;
}

class Work {
 public:
  Work(const CaptureFile& capture, const SceneLightOptions& options)
      : capture_(capture), options_(options) {}

  SceneLight run() {
    step("read", [&] { read(); });
    step("response", [&] { find_response(); });
    step("merge", [&] { merge(); });
    step("patches", [&] { make_patches(); });
    step("probe", [&] { look_at_probe(); });
    step("photograph", [&] { look_at_photograph(); });
    step("balance", [&] { balance(); });
    step("map", [&] { make_map(); });
    return std::move(result_);
  }

 private:
  template <class Body>
  void step(const char* name, const Body& body) {
    if (options_.progress) options_.progress(name, static_cast<int>(result_.step_ms.size()));
    Stopwatch watch;
    body();
    result_.step_ms.emplace_back(name, watch.lap_ms());
  }
  void note(std::string text) { result_.notes.push_back(std::move(text)); }
  const BallProbe* ball_probe() const { return std::get_if<BallProbe>(&capture_.probe); }

  void read() {
    CaptureModel model = read_capture_model(capture_.model, capture_.leave_out);
    for (const std::string& text : model.notes)
      note(fmt::format("{}: {}", capture_.model.string(), text));
    model_scene_ = std::move(model.scene);
    surface_reflectance_ = std::move(model.reflectance);
    camera_ = read_camera(capture_.camera);
    photograph_ = read_image_rgb(capture_.photograph);
    sets_.push_back(read_brackets(capture_.photograph_brackets));
    if (photograph_.width != sets_[0].width() || photograph_.height != sets_[0].height())
      throw InputError(fmt::format("{}: {} x {} pixels, but its brackets have {} x {}",
                                   capture_.photograph.string(), photograph_.width,
                                   photograph_.height, sets_[0].width(), sets_[0].height()));
    const std::optional<double> time_s =
        capture_.exposure_time_s ? capture_.exposure_time_s : sets_[0].photograph_time_s;
    if (!time_s)
      throw InputError(fmt::format(
          "{}: [photograph].exposure_time_s: missing, and {} has no auto_exposure_time_s",
          capture_.file.string(), capture_.photograph_brackets.string()));
    time_s_ = *time_s;
    lens_.emplace(camera_for(sets_[0], capture_.photograph_brackets));
    if (const BallProbe* probe = ball_probe()) {
      sets_.push_back(read_brackets(probe->brackets));
      probe_lens_.emplace(camera_for(sets_[1], probe->brackets));
    } else {
      const LatlongProbe& latlong = std::get<LatlongProbe>(capture_.probe);
      probe_picture_ = read_float_image(latlong.picture);
      for (const float v : probe_picture_.pixels)
        if (v < 0.0f)
          throw InputError(
              fmt::format("{}: has negative radiance {:g}", latlong.picture.string(), v));
    }
  }

  CameraModel camera_for(const Brackets& set, const std::filesystem::path& list) const {
    try {
      return camera_for_picture(camera_, set.width(), set.height());
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", list.string(), error.what()));
    }
  }

  void find_response() {
    curve_ = fit_response(sets_, {.threads = options_.threads});
    result_.scene.tone = tone_of(curve_);
  }

  void merge() {
    MergedRadiance merged = merge_radiance(sets_[0], curve_, options_.threads);
    note_ends(merged, sets_[0]);
    picture_ = std::move(merged.picture);
    scale(picture_, glm::dvec3(time_s_));
    check_photograph();
    if (ball_probe() == nullptr) return;
    MergedRadiance probe = merge_radiance(sets_[1], curve_, options_.threads);
    note_ends(probe, sets_[1]);
    probe_picture_ = std::move(probe.picture);
    scale(probe_picture_, time_s_ / ball_probe()->ball.reflectance);
  }

  void note_ends(const MergedRadiance& merged, const Brackets& set) {
    if (merged.saturated > 0)
      note(fmt::format("{}: {} pixels are saturated in every exposure: brighter than they count",
                       set.list.string(), merged.saturated));
  }

  /// The photograph must be what its brackets say it is.
  void check_photograph() {
    std::vector<double> differences;
    for (std::size_t i = 0; i < photograph_.pixels.size(); i += 5) {
      const double expected =
          result_.scene.tone.value(i % 3, static_cast<double>(picture_.pixels[i]));
      differences.push_back(std::abs(expected - photograph_.pixels[i]));
    }
    const double middle = median(std::move(differences));
    if (middle > kOtherTime)
      throw InputError(
          fmt::format("{}: its values are {:.0f} (median) from what its brackets say for {:g} s: "
                      "is that its time?",
                      capture_.photograph.string(), middle, time_s_));
  }

  void make_patches() {
    const std::size_t most = pipeline::PatchExchange::kMostPatches - (capture_.sun ? 1 : 0);
    const auto count = std::min(
        static_cast<std::size_t>(options_.patches > 0 ? options_.patches : capture_.patches), most);
    try {
      model() = pipeline::make_patches(model_scene_, count);
    } catch (const std::invalid_argument& error) {
      throw InputError(fmt::format("{}: {}", capture_.model.string(), error.what()));
    }
    if (model().patches.size() > most)
      throw InputError(fmt::format("{}: {} triangles, of at most {}", capture_.model.string(),
                                   model().patches.size(), most));
    add_sun();
    visibility_.emplace(model());
    known_.assign(model().patches.size(), false);
    radiance_.assign(model().patches.size(), glm::dvec3(0.0));
  }

  /// Its patch comes after all others, with a radiance that is found with the balance.
  void add_sun() {
    if (!capture_.sun) return;
    std::vector<std::uint32_t> through;
    for (const std::string& name : capture_.sun->through) {
      const auto at = std::ranges::find(model().surfaces, name);
      if (at == model().surfaces.end())
        throw InputError(fmt::format("{}: [sun].through: {} has no surface '{}'",
                                     capture_.file.string(), capture_.model.string(), name));
      through.push_back(static_cast<std::uint32_t>(at - model().surfaces.begin()));
    }
    pipeline::add_sun(model(), capture_.sun->direction, std::move(through));
    surface_reflectance_.emplace_back(0.0f);
  }

  pipeline::PatchModel& model() { return result_.scene.model; }

  void look_at_probe() {
    FootprintOptions options{options_.samples, options_.threads};
    FootprintWindow window{0, 0, probe_picture_.width, probe_picture_.height};
    RayOfPlace ray;
    if (const BallProbe* probe = ball_probe()) {
      window = open_ball(*probe);
      ray = [this](glm::dvec2 place) { return ball_->ray(place); };
    } else {
      latlong_.emplace(std::move(probe_picture_), std::get<LatlongProbe>(capture_.probe));
      window = {0, 0, latlong_->bordered().width, latlong_->bordered().height};
      ray = [this](glm::dvec2 place) { return std::optional(latlong_->ray(place)); };
      constexpr std::int64_t kMostCells = std::int64_t{1} << 22;
      while (options.samples > 1 &&
             std::int64_t{window.x1} * window.y1 * options.samples * options.samples > kMostCells)
        --options.samples;
    }
    const FloatImage& picture = latlong_ ? latlong_->bordered() : probe_picture_;
    const PixelFootprints pixels =
        find_footprints(picture, window, ray, *visibility_, model(), options);
    const SharedRadiance shared = share_radiance(pixels, model().patches.size(), options_.rounds);
    for (std::size_t i = 0; i < known_.size(); ++i) {
      known_[i] = shared.pixels[i] >= kLeastProbePixels;
      if (known_[i]) radiance_[i] = shared.radiance[i];
    }
    note_probe(pixels);
  }

  FootprintWindow open_ball(const BallProbe& probe) {
    const std::string list = probe.brackets.string();
    const std::optional<BallOutline> outline =
        ball_outline(probe.ball, *probe_lens_, probe.world_from_camera, probe_picture_.width,
                     probe_picture_.height);
    if (!outline || outline->x0 >= outline->x1 || outline->y0 >= outline->y1)
      throw InputError(fmt::format("{}: the ball is not in the picture", list));
    if (outline->inside < 1.0)
      note(fmt::format("{}: {:.0f} % of the ball's outline is outside of the picture", list,
                       100.0 * (1.0 - outline->inside)));
    const double margin = std::min(0.5, kRimPx / std::max(1.0, outline->radius_px));
    ball_.emplace(BallPicture{probe_picture_, *probe_lens_, probe.world_from_camera, probe.ball,
                              std::sqrt(1.0 - (1.0 - margin) * (1.0 - margin))});
    return {outline->x0, outline->y0, outline->x1, outline->y1};
  }

  void note_probe(const PixelFootprints& pixels) {
    if (std::none_of(known_.begin(), known_.end(), [](bool k) { return k; }))
      throw InputError(fmt::format("{}: the probe shows no front of any patch of {}",
                                   capture_.file.string(), capture_.model.string()));
    const double open = pixels.open_sr / pixels.total_sr, back = pixels.back_sr / pixels.total_sr;
    if (open > 0.01)
      note(fmt::format("{}: open: {:.0f} % of what the probe sees is past it, and gives no light",
                       capture_.model.string(), 100.0 * open));
    if (back > 0.01)
      note(fmt::format("{}: {:.0f} % of what the probe sees are back sides, which give no light",
                       capture_.model.string(), 100.0 * back));
  }

  void look_at_photograph() {
    const PhotographRadiance seen =
        photograph_radiance(picture_, *lens_, capture_.world_from_camera, *visibility_, model(),
                            kMarginPx, options_.threads);
    std::array<std::vector<double>, 3> ratios;
    for (std::size_t i = 0; i < known_.size(); ++i) {
      if (seen.pixels[i] < kLeastPhotographPixels || !known_[i]) continue;
      for (std::size_t c = 0; c < 3; ++c)
        if (const double probe = radiance_[i][static_cast<int>(c)]; probe > 0.0)
          ratios[c].push_back(seen.radiance[i][static_cast<int>(c)] / probe);
    }
    for (int c = 0; c < 3; ++c)
      result_.photograph_over_probe[c] = median(std::move(ratios[static_cast<std::size_t>(c)]));
    fit_latlong();
    for (std::size_t i = 0; i < known_.size(); ++i) {
      const bool fine = seen.pixels[i] >= kLeastPhotographPixels;
      result_.from_photograph += fine ? 1 : 0;
      result_.from_probe += !fine && known_[i] ? 1 : 0;
      if (!fine) continue;
      known_[i] = true;
      radiance_[i] = seen.radiance[i];
    }
    result_.filled = model().near_count() - result_.from_photograph - result_.from_probe;
  }

  /// Brings a latitude-longitude picture, in whatever unit, to the photograph's.
  void fit_latlong() {
    if (!latlong_) return;
    const LatlongProbe& probe = std::get<LatlongProbe>(capture_.probe);
    const glm::dvec3 factor = probe.scale.value_or(result_.photograph_over_probe);
    if (!(factor.x > 0.0 && factor.y > 0.0 && factor.z > 0.0))
      throw InputError(
          fmt::format("{}: [probe].scale: missing, and no patch is seen by probe and photograph "
                      "that would tell it",
                      capture_.file.string()));
    for (glm::dvec3& radiance : radiance_) radiance *= factor;
    scale(latlong_->bordered(), factor);
  }

  void balance() {
    const pipeline::PatchExchange exchange(model(), *visibility_, options_.visibility_samples,
                                           options_.threads);
    BalanceInput input{std::move(radiance_), std::move(known_), surface_reflectance_};
    if (capture_.sun) set_sun(exchange, input);
    Balanced balanced = balance_patches(model(), exchange, input, options_.threads);
    result_.scene.radiance = std::move(balanced.radiance);
    result_.scene.reflectance = std::move(balanced.reflectance);
    const auto near_end =
        balanced.emits.begin() + static_cast<std::ptrdiff_t>(model().near_count());
    result_.emitting = static_cast<std::size_t>(std::count(balanced.emits.begin(), near_end, true));
  }

  void set_sun(const pipeline::PatchExchange& exchange, BalanceInput& input) {
    const std::uint32_t sun = pipeline::sun_patch(model());
    input.known[sun] = true;
    std::optional<glm::dvec3> irradiance = capture_.sun->irradiance;
    if (!irradiance) {
      irradiance = find_sun_irradiance(model(), exchange, *visibility_, input, options_.threads);
      if (!irradiance)
        throw InputError(fmt::format(
            "{}: [sun].irradiance: missing, and no surface is seen both in the sun and in the "
            "shade that would tell it",
            capture_.file.string()));
      note(fmt::format("sunlight: {:.3g} {:.3g} {:.3g} on a surface that faces it", irradiance->x,
                       irradiance->y, irradiance->z));
    }
    input.radiance[sun] = pipeline::sun_radiance(*irradiance);
  }

  void make_map() {
    const auto seen = [this](const glm::dvec4& towards) -> std::optional<glm::dvec3> {
      if (ball_) return ball_->seen(towards);
      const glm::dvec3 center = std::get<LatlongProbe>(capture_.probe).center_m;
      return latlong_->seen(glm::dvec3(towards) - center * towards.w);
    };
    const glm::dvec3 center =
        ball_ ? ball_->ball.center_m : std::get<LatlongProbe>(capture_.probe).center_m;
    result_.scene.probe =
        make_direction_map(center, seen, result_.scene.radiance, *visibility_, options_.threads);
  }

  const CaptureFile& capture_;
  const SceneLightOptions& options_;
  SceneLight result_;
  pipeline::Scene model_scene_;
  std::vector<glm::vec3> surface_reflectance_;
  CameraModel camera_;
  std::optional<Lens> lens_, probe_lens_;
  Image photograph_;
  double time_s_ = 1.0;
  /// The photograph's brackets, then the ball's.
  std::vector<Brackets> sets_;
  ExposureCurve curve_;
  FloatImage picture_, probe_picture_;
  std::optional<BallPicture> ball_;
  std::optional<LatlongPicture> latlong_;
  std::optional<pipeline::PatchVisibility> visibility_;
  std::vector<bool> known_;
  std::vector<glm::dvec3> radiance_;
};

}  // namespace

SceneLight find_scene_light(const CaptureFile& capture, const SceneLightOptions& options) {
  return Work(capture, options).run();
}

}  // namespace gnomon::ar
