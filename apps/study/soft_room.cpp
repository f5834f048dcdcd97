#include "apps/study/soft_room.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "ar/capture_file.h"
#include "ar/differential_augment.h"
#include "ar/error.h"
#include "ar/file.h"
#include "ar/image_file.h"
#include "ar/scene_file.h"
#include "ar/scene_light.h"
#include "ar/scene_models.h"
#include "ar/scene_nodes.h"
#include "pipeline/finish_picture.h"
#include "raster/check.h"
#include "raster/execute.h"

namespace gnomon::apps::study {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSceneFiles[] = {"box.toml", "suzanne.toml"};
/// A second place, metres from the file's, on the floor's free part.
constexpr glm::vec3 kMoved{-0.25f, 0.0f, 0.2f};

using pipeline::ShadowPrecision;

bool is_wide(ShadowPrecision precision) {
  return precision == ShadowPrecision::values || precision == ShadowPrecision::radiance;
}

std::size_t not_finite(const raster::ColorBuffer& color, int width, int height) {
  if (color.format() != raster::ColorFormat::rgba32f) return 0;
  std::size_t count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec4& c = color.rgba32f().at(x, y);
      for (int i = 0; i < 4; ++i) count += std::isfinite(c[i]) ? 0 : 1;
    }
  return count;
}

/// A value that is what it was when this goes.
template <class T>
class Restored {
 public:
  explicit Restored(T& value) : value_(value), was_(value) {}
  ~Restored() { value_ = std::move(was_); }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;

 private:
  T& value_;
  T was_;
};

}  // namespace

struct SoftRoom::Impl {
  fs::path folder;
  int threads;
  std::optional<ar::SceneFile> file;
  std::optional<ar::PinholeView> view;
  ar::Image photograph;
  pipeline::Camera camera;
  pipeline::LitScene lit;
  std::vector<std::uint32_t> receivers;
  /// By share of power.
  struct Light {
    pipeline::LightPaths paths;
    std::optional<pipeline::DifferentialMethod> method;
  };
  std::map<double, Light> lights;
  std::array<pipeline::Scene, kScenes> scenes;
  pipeline::ReducedOccluders occluders{ar::DifferentialSettings{}.occluder_triangles};
  std::map<std::size_t, std::vector<std::size_t>> regions;

  void load() {
    if (view) return;
    const ar::CaptureFile capture = ar::read_capture(folder);
    lit = ar::find_scene_light(capture, {.threads = threads}).scene;
    const ar::Image taken = ar::read_image_rgb(capture.photograph);
    const ar::Lens lens(
        ar::camera_for_picture(ar::read_camera(capture.camera), taken.width, taken.height));
    ar::PinholeView pinhole(lens, 1);
    photograph = pinhole.resample(taken);
    for (std::size_t i = 0; i < kScenes; ++i) {
      file = ar::read_scene(folder / kSceneFiles[i / 2]);
      pipeline::Scene& scene = scenes[i];
      scene = ar::SceneNodes(*file, ar::load_models(*file)).scene();
      if (i % 2 == 1)
        for (pipeline::Object& object : scene.objects)
          object.world_from_model[3] += glm::vec4(kMoved, 0.0f);
      occluders.apply(scene);
    }
    if (!file->world_from_camera)
      throw ar::InputError(ar::one_line(file->file.string()) +
                           ": [camera].world_from_camera: missing");
    camera = pinhole.camera(*file->world_from_camera, file->near_m, file->far_m);
    receivers = ar::visible_patches(lit, camera);
    view = std::move(pinhole);
  }

  Light& light_of(double power_share) {
    load();
    const auto [found, fresh] = lights.try_emplace(power_share);
    Light& light = found->second;
    if (fresh) {
      pipeline::LightPathOptions options;
      options.transfer.power_share = power_share;
      options.transfer.threads = threads;
      light.paths = pipeline::find_light_paths(lit, receivers, options);
      light.method.emplace(lit, light.paths);
    }
    return light;
  }

  SoftPicture draw(std::size_t scene, double power_share, const pipeline::ShadowTakeOptions& take,
                   const pipeline::ToneCurve* tone) {
    Light& light = light_of(power_share);
    // The method looks at the curve while it records, and nothing else of the light depends on it.
    const Restored<pipeline::ToneCurve> own(lit.tone);
    if (tone) lit.tone = *tone;
    const int width = view->width(), height = view->height();
    raster::ColorBuffer color(
        width, height,
        is_wide(take.precision) ? raster::ColorFormat::rgba32f : raster::ColorFormat::rgba8);
    raster::DepthBuffer depth(width, height);
    raster::StencilBuffer stencil(width, height);
    const auto under = raster::ImageView::from_top_row(photograph.pixels.data(), width, height, 3);
    pipeline::DifferentialOptions options{.take = take};
    options.take.threads = threads;
    raster::execute(
        light.method->record(scenes[scene], camera, under, {&color, &depth, &stencil}, options),
        {.threads = threads});
    SoftPicture out{pipeline::finish_picture(under, color, lit.tone, options.take),
                    not_finite(color, width, height), light.method->shadows().shadows.size()};
    return out;
  }
};

SoftRoom::SoftRoom(fs::path folder, int threads) : impl_(std::make_unique<Impl>()) {
  impl_->folder = std::move(folder);
  impl_->threads = threads;
}
SoftRoom::~SoftRoom() = default;

const pipeline::LitScene& SoftRoom::lit() {
  impl_->load();
  return impl_->lit;
}

std::size_t SoftRoom::sources(double power_share) {
  return impl_->light_of(power_share).paths.transfers.sources.size();
}

SoftPicture SoftRoom::draw(std::size_t scene, double power_share,
                           const pipeline::ShadowTakeOptions& take,
                           const pipeline::ToneCurve* tone) {
  return impl_->draw(scene, power_share, take, tone);
}

const std::vector<std::size_t>& SoftRoom::shadow_region(std::size_t scene) {
  auto found = impl_->regions.find(scene);
  if (found != impl_->regions.end()) return found->second;
  pipeline::ShadowTakeOptions all;
  all.passes = sources(1.0);
  all.precision = ShadowPrecision::radiance;
  const SoftPicture shadowed = impl_->draw(scene, 1.0, all, nullptr);
  const ar::Image& photo = impl_->photograph;
  std::vector<std::size_t> region;
  for (int y = 0; y < photo.height; ++y)
    for (int x = 0; x < photo.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * photo.width + x;
      const std::uint8_t* now = shadowed.rows.data() + i * 4;
      const std::uint8_t* before = photo.at(x, photo.height - 1 - y);
      bool darker = false;
      for (int c = 0; c < 3; ++c) darker = darker || before[c] - now[c] >= 2;
      if (darker && now[3] == 0) region.push_back(i);
    }
  return impl_->regions.emplace(scene, std::move(region)).first->second;
}

double differing(const SoftPicture& a, const SoftPicture& b, const std::vector<std::size_t>& region,
                 int bound) {
  double count = 0.0;
  for (const std::size_t i : region) {
    bool off = false;
    for (std::size_t c = 0; c < 3; ++c)
      off = off || std::abs(a.rows[i * 4 + c] - b.rows[i * 4 + c]) > bound;
    count += off;
  }
  return count;
}

}  // namespace gnomon::apps::study
