#include "ar/differential_augment.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "ar/composite.h"
#include "ar/photo_planes.h"
#include "ar/stopwatch.h"
#include "pipeline/pass_budget.h"
#include "pipeline/ray_reference.h"
#include "pipeline/reduced_occluder.h"
#include "raster/execute.h"
#include "raster/frame_format.h"

namespace gnomon::ar {

namespace {

std::vector<std::uint32_t> all_patches(const pipeline::LitScene& scene) {
  std::vector<std::uint32_t> all(scene.model.near_count());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace

pipeline::Scene virtual_ones(pipeline::Scene scene) {
  std::erase_if(scene.objects, [](const pipeline::Object& object) {
    return object.role != pipeline::Role::virtual_object;
  });
  return scene;
}

std::vector<std::uint32_t> visible_patches(const pipeline::LitScene& scene,
                                           const pipeline::Camera& camera) {
  constexpr int kStep = 4;
  const pipeline::PatchVisibility visibility(scene.model);
  std::vector<std::uint8_t> vertices(scene.model.vertices.size(), 0);
  for (int y = 0; y < camera.height; y += kStep) {
    for (int x = 0; x < camera.width; x += kStep) {
      const pipeline::Ray ray = pipeline::window_ray(camera, x + 0.5, y + 0.5);
      const auto hit = visibility.trace(ray.origin, ray.direction);
      if (hit.patch == pipeline::PatchVisibility::kNone || !hit.front) continue;
      for (const std::uint32_t v : scene.model.patches[hit.patch].vertices) vertices[v] = 1;
    }
  }
  std::vector<std::uint32_t> patches;
  for (std::uint32_t i = 0, near = static_cast<std::uint32_t>(scene.model.near_count()); i < near;
       ++i) {
    const auto& corners = scene.model.patches[i].vertices;
    if (std::any_of(corners.begin(), corners.end(), [&](std::uint32_t v) { return vertices[v]; }))
      patches.push_back(i);
  }
  return patches;
}

struct DifferentialAugmenter::Impl {
  DifferentialSettings settings;
  PinholeView view;
  std::shared_ptr<const pipeline::LitScene> scene;
  pipeline::LightPaths paths;
  std::optional<pipeline::DifferentialMethod> method;
  std::optional<pipeline::PassBudget> budget;
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;
  raster::ExecuteMemory memory;
  pipeline::ReducedOccluders occluders;
  pipeline::PictureFinish finish;
  DifferentialReport report;

  Impl(const Lens& lens, std::shared_ptr<const pipeline::LitScene> lit,
       const std::optional<glm::dmat4>& still_camera, const DifferentialSettings& s)
      : settings(s),
        view(lens, s.samples == 0 ? 1 : s.samples),
        scene(std::move(lit)),
        color(view.width(), view.height(),
              is_wide() ? raster::ColorFormat::rgba32f : raster::ColorFormat::rgba8),
        depth(view.width(), view.height()),
        stencil(view.width(), view.height()),
        occluders(settings.occluder_triangles),
        finish(scene->tone, settings.method.take) {
    settings.light.transfer.threads = settings.threads;
    settings.method.take.threads = settings.threads;
    const std::vector<std::uint32_t> receivers =
        still_camera
            ? visible_patches(*scene, view.camera(*still_camera, settings.near_m, settings.far_m))
            : all_patches(*scene);
    paths = pipeline::find_light_paths(*scene, receivers, settings.light);
    method.emplace(*scene, paths);
    const std::size_t sources = paths.transfers.sources.size();
    if (settings.budget_ms > 0.0 && sources > 0) budget.emplace(settings.budget_ms, sources);
  }

  bool is_wide() const {
    const pipeline::ShadowPrecision precision = settings.method.take.precision;
    return precision == pipeline::ShadowPrecision::values ||
           precision == pipeline::ShadowPrecision::radiance;
  }

  /// Runs the frame, stopping after each pass of the picture where its buffers are asked for.
  void execute(const raster::Frame& frame, Augmented& out) {
    std::size_t done = 0, end = 0;
    for (const raster::Pass& pass : frame.passes()) {
      end += pass.commands.size();
      out.passes.push_back({pass.label, pass.commands.size()});
      if (!settings.steps || pass.targets.color != &color) continue;
      raster::execute(
          frame,
          {.threads = settings.threads, .memory = &memory, .first_command = done, .commands = end});
      done = end;
      out.steps.push_back({pass.label, color_at_photo(view, color), depth_at_photo(view, depth),
                           stencil_at_photo(view, stencil)});
    }
    raster::execute(frame, {.threads = settings.threads, .memory = &memory, .first_command = done});
  }

  /// r: a shadow fell there; b: a virtual object is visible; as rows from the bottom.
  /// `photograph` is only looked at where shadows take no share.
  std::vector<std::uint8_t> masks(const raster::ImageView& photograph) const {
    std::vector<std::uint8_t> rows;
    rows.reserve(std::size_t{4} * view.width() * view.height());
    const auto add = [&](bool object, bool kept) {
      for (const bool set : {!object && !kept, false, object, true}) rows.push_back(set ? 255 : 0);
    };
    const auto is_photograph = [&](int x, int y, const auto& drawn) {
      return std::ranges::equal(finish.pixel(photograph.pixel(x, y), drawn),
                                std::span(photograph.pixel(x, y), 3));
    };
    const auto look = [&](int x, int y, const auto& drawn, bool object) {
      add(object, settings.method.take.by_share ? finish.keeps(drawn) : is_photograph(x, y, drawn));
    };
    for (int y = 0; y < view.height(); ++y) {
      for (int x = 0; x < view.width(); ++x) {
        if (is_wide())
          look(x, y, color.rgba32f().at(x, y), color.rgba32f().at(x, y).w != 0.0f);
        else
          look(x, y, color.rgba8().at(x, y), color.rgba8().at(x, y)[3] != 0);
      }
    }
    return rows;
  }
};

DifferentialAugmenter::DifferentialAugmenter(const Lens& lens,
                                             std::shared_ptr<const pipeline::LitScene> scene,
                                             const std::optional<glm::dmat4>& still_camera,
                                             const DifferentialSettings& settings)
    : impl_(std::make_unique<Impl>(lens, std::move(scene), still_camera, settings)) {}
DifferentialAugmenter::~DifferentialAugmenter() = default;
DifferentialAugmenter::DifferentialAugmenter(DifferentialAugmenter&&) noexcept = default;

const PinholeView& DifferentialAugmenter::view() const { return impl_->view; }
const pipeline::LightPaths& DifferentialAugmenter::paths() const { return impl_->paths; }
void DifferentialAugmenter::keep_steps(bool keep) { impl_->settings.steps = keep; }

void DifferentialAugmenter::set_passes(std::size_t passes) {
  impl_->settings.method.take.passes = passes;
}
const DifferentialReport& DifferentialAugmenter::report() const { return impl_->report; }

Augmented DifferentialAugmenter::augment(const Image& photograph, const pipeline::Scene& objects,
                                         const glm::dmat4& world_from_camera) {
  Impl& at = *impl_;
  Augmented out;
  Stopwatch watch, whole;
  // Shares are taken of the photograph's own pixels.
  const bool by_share = at.settings.method.take.by_share;
  const Image resampled = by_share ? Image{} : at.view.resample(photograph);
  out.resample_ms = watch.lap_ms();

  const pipeline::Camera camera =
      at.view.camera(world_from_camera, at.settings.near_m, at.settings.far_m);
  const auto picture = raster::ImageView::from_top_row(resampled.pixels.data(), resampled.width,
                                                       resampled.height, 3);
  pipeline::DifferentialOptions options = at.settings.method;
  if (at.budget) options.take.passes = at.budget->passes();
  pipeline::Scene scene = virtual_ones(objects);
  at.occluders.apply(scene);
  const raster::Frame frame =
      at.method->record(scene, camera, picture, {&at.color, &at.depth, &at.stencil}, options);
  if (at.settings.frame) out.frame = raster::encode_frame(frame);
  out.record_ms = watch.lap_ms();

  at.execute(frame, out);
  out.execute_ms = watch.lap_ms();

  const int threads = at.settings.threads;
  out.composite =
      by_share
          ? composite(at.view, photograph, at.color, at.finish, threads)
          : composite(at.view, photograph, resampled,
                      pipeline::finish_picture(picture, at.color, at.scene->tone, options.take),
                      threads);
  if (at.settings.masks) {
    const std::vector<std::uint8_t> rows = at.masks(picture);
    out.shadow_mask = mask_at_photo(at.view, rows, 0, threads);
    out.shadow_on_virtual = mask_at_photo(at.view, rows, 1, threads);
    out.object_mask = mask_at_photo(at.view, rows, 2, threads);
  }
  out.composite_ms = watch.lap_ms();
  const pipeline::DifferentialShadows& shadows = at.method->shadows();
  at.report = {shadows.occluded_sources, shadows.receivers, shadows.shadows.size(),
               shadows.left_out, at.method->traverse_ms()};
  if (at.budget) at.budget->add(shadows.shadows.size(), whole.lap_ms());
  return out;
}

}  // namespace gnomon::ar
