#include "ar/augment.h"

#include "ar/composite.h"
#include "ar/photo_planes.h"
#include "ar/stopwatch.h"
#include "pipeline/light_samples.h"
#include "raster/execute.h"
#include "raster/frame_format.h"

namespace gnomon::ar {

struct Augmenter::Impl {
  AugmentOptions options;
  PinholeView view;
  pipeline::TopologyCache topologies;
  std::unique_ptr<raster::ColorBuffer> color, masks;
  std::unique_ptr<raster::DepthBuffer> depth;
  std::unique_ptr<raster::StencilBuffer> stencil;

  Impl(const Lens& lens, const AugmentOptions& o) : options(o), view(lens, o.samples) {
    depth = std::make_unique<raster::DepthBuffer>(view.width(), view.height());
    stencil = std::make_unique<raster::StencilBuffer>(view.width(), view.height());
    if (options.masks) masks = std::make_unique<raster::ColorBuffer>(view.width(), view.height());
  }

  raster::Targets targets(const pipeline::Scene& scene) {
    const auto format = pipeline::sample_lights(scene).size() == 1 ? raster::ColorFormat::rgba8
                                                                   : raster::ColorFormat::rgba32f;
    if (!color || color->format() != format)
      color = std::make_unique<raster::ColorBuffer>(view.width(), view.height(), format);
    return {color.get(), depth.get(), stencil.get()};
  }

  /// Runs the frame, stopping after passes whose buffers are looked at.
  void execute(const raster::Frame& frame, Augmented& out) {
    std::size_t done = 0, end = 0;
    bool counted = false;
    for (const raster::Pass& pass : frame.passes()) {
      end += pass.commands.size();
      out.passes.push_back({pass.label, pass.commands.size()});
      const bool counts =
          options.masks && !counted && pass.label.starts_with(pipeline::haller_label::kAllVolumes);
      if (!counts && !options.steps) continue;
      raster::execute(frame, {.threads = options.threads, .first_command = done, .commands = end});
      done = end;
      if (counts) {
        counted = true;
        out.stencil_counts = stencil_at_photo(view, *stencil);
      }
      if (options.steps && pass.targets.color == color.get())
        out.steps.push_back({pass.label, color_at_photo(view, *color), depth_at_photo(view, *depth),
                             stencil_at_photo(view, *stencil)});
    }
    raster::execute(frame, {.threads = options.threads, .first_command = done});
  }
};

void Augmenter::keep_steps(bool keep) { impl_->options.steps = keep; }

Augmenter::Augmenter(const Lens& lens, const AugmentOptions& options)
    : impl_(std::make_unique<Impl>(lens, options)) {}
Augmenter::~Augmenter() = default;
Augmenter::Augmenter(Augmenter&&) noexcept = default;

const PinholeView& Augmenter::view() const { return impl_->view; }

Augmented Augmenter::augment(const Image& photograph, const pipeline::Scene& scene,
                             const glm::dmat4& world_from_camera) {
  Impl& at = *impl_;
  Augmented out;
  Stopwatch watch;
  const Image resampled = at.view.resample(photograph);
  out.resample_ms = watch.lap_ms();

  const pipeline::Camera camera =
      at.view.camera(world_from_camera, at.options.near_m, at.options.far_m);
  const auto picture = raster::ImageView::from_top_row(resampled.pixels.data(), resampled.width,
                                                       resampled.height, 3);
  pipeline::HallerOptions method;
  method.method = at.options.method;
  method.extrusion = at.options.extrusion;
  method.double_shadows = at.options.double_shadows;
  method.masks = at.masks.get();
  method.topologies = &at.topologies;
  const raster::Frame frame =
      pipeline::record_haller(scene, camera, picture, at.targets(scene), method);
  if (at.options.frame) out.frame = raster::encode_frame(frame);
  out.record_ms = watch.lap_ms();

  at.execute(frame, out);
  out.execute_ms = watch.lap_ms();

  const int threads = at.options.threads;
  out.composite = composite(at.view, photograph, resampled, at.color->to_rgba8_rows(), threads);
  if (at.masks) {
    const std::vector<std::uint8_t> rows = at.masks->to_rgba8_rows();
    out.shadow_mask = mask_at_photo(at.view, rows, 0, threads);
    out.shadow_on_virtual = mask_at_photo(at.view, rows, 1, threads);
    out.object_mask = mask_at_photo(at.view, rows, 2, threads);
  }
  out.composite_ms = watch.lap_ms();
  return out;
}

}  // namespace gnomon::ar
