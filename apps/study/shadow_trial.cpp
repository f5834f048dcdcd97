#include "apps/study/shadow_trial.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "ar/stopwatch.h"
#include "pipeline/ray_reference.h"
#include "pipeline/reduced_occluder.h"
#include "raster/check.h"
#include "raster/execute.h"
#include "raster/executor.h"

namespace gnomon::apps::study {

using pipeline::RayReference;

namespace {

/// What an answer says of a pixel that is not compared.
constexpr float kNotTested = -1.0f;

struct Buffers {
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;
  Buffers(const pipeline::Camera& camera, raster::ColorFormat color_format,
          raster::DepthFormat depth_format)
      : color(camera.width, camera.height, color_format),
        depth(camera.width, camera.height, depth_format),
        stencil(camera.width, camera.height) {}
};

/// Kept between frames.
struct Memory {
  pipeline::TopologyCache topologies;
  pipeline::VolumeMemory volumes;
  pipeline::MapMemory maps;
  pipeline::AliasFreeMemory alias_free;
  raster::ExecuteMemory executing;
};

pipeline::GeneralOptions general_options(const ShadowSetting& setting, Memory& memory,
                                         int threads) {
  return {.method = setting.counting,
          .extrusion = setting.extrusion,
          .geometry = setting.geometry,
          .classical = setting.classical,
          .counts = setting.counts,
          .appendix_letter = setting.appendix_letter,
          .single_sided = setting.single_sided,
          .topologies = &memory.topologies,
          .volumes = &memory.volumes,
          .maps = &memory.maps,
          .alias_free = &memory.alias_free,
          .threads = threads};
}

/// The channel of the largest light, and how large it is.
std::pair<int, float> strongest(const glm::vec4& lit, const glm::vec4& unlit) {
  int channel = 0;
  for (int c = 1; c < 3; ++c)
    if (lit[c] - unlit[c] > lit[channel] - unlit[channel]) channel = c;
  return {channel, lit[channel] - unlit[channel]};
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// One sample a ray.
std::vector<RayReference::Sample> cast_on_threads(const RayReference& rays,
                                                  std::span<const pipeline::Ray> all,
                                                  const glm::vec4& light, int threads) {
  constexpr std::size_t kChunk = 4096;
  std::vector<RayReference::Sample> out(all.size());
  raster::for_each_chunk(all.size(), kChunk, threads, [&](std::size_t first, std::size_t last) {
    std::ranges::copy(rays.cast(all.subspan(first, last - first), light),
                      out.begin() + static_cast<std::ptrdiff_t>(first));
  });
  return out;
}

}  // namespace

struct ShadowTrial::Impl {
  View view;
  int threads;
  Memory memory;
  /// With the light and without it, no shadow: what is drawn when the depth buffer has a format.
  struct Bare {
    Buffers lit, unlit;
  };
  std::optional<Bare> bare_d24, bare_d16;
  /// 1, 0 or kNotTested a pixel, rows from the bottom.
  std::vector<float> truth;
  std::size_t tested = 0, in_shadow = 0;
  /// The part of the light that the last run left out, and its picture's depth format.
  std::vector<float> dark;
  raster::DepthFormat last_format = raster::DepthFormat::d24;
  std::map<raster::DepthFormat, Buffers> timed;
  std::map<std::size_t, pipeline::Scene> reduced;

  Impl(View given, int thread_count) : view(std::move(given)), threads(thread_count) {
    raster::require(view.scene.lights.size() == 1 && view.scene.lights[0].samples <= 1,
                    "a trial has one light of one sample");
    find_truth();
  }

  Bare& bare(raster::DepthFormat format) {
    std::optional<Bare>& at = format == raster::DepthFormat::d24 ? bare_d24 : bare_d16;
    if (!at) {
      const ShadowSetting none{.method = pipeline::ShadowMethod::none};
      at.emplace(Bare{{view.camera, raster::ColorFormat::rgba32f, format},
                      {view.camera, raster::ColorFormat::rgba32f, format}});
      pipeline::Scene dark_scene = view.scene;
      draw(at->lit, view.scene, none);
      dark_scene.lights[0].color = glm::vec3(0.0f);
      draw(at->unlit, dark_scene, none);
    }
    return *at;
  }

  /// Milliseconds.
  double draw(Buffers& buffers, pipeline::Scene scene, const ShadowSetting& setting) {
    scene.lights[0].shadow = setting.method;
    scene.lights[0].shadow_of_object.clear();
    scene.lights[0].map = setting.map;
    ar::Stopwatch watch;
    const raster::Frame frame = pipeline::record_general(
        scene, view.camera, {&buffers.color, &buffers.depth, &buffers.stencil},
        general_options(setting, memory, threads));
    raster::execute(frame, {.threads = threads, .memory = &memory.executing});
    return watch.lap_ms();
  }

  /// The scene whose objects cast with so many triangles.
  const pipeline::Scene& with_casters(std::size_t triangles) {
    const auto [at, fresh] = reduced.try_emplace(triangles, view.scene);
    if (fresh) pipeline::ReducedOccluders(triangles).apply(at->second);
    return at->second;
  }

  void find_truth() {
    const RayReference rays(view.scene);
    const auto samples = cast_on_threads(rays, pipeline::pixel_rays(view.camera),
                                         view.scene.lights[0].position, threads);
    const Bare& at = bare(raster::DepthFormat::d24);
    truth.assign(samples.size(), kNotTested);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const RayReference::Sample& sample = samples[i];
      if (!sample.hit.hit || sample.shadow.faces_away) continue;
      const pipeline::Object& object = view.scene.objects[sample.hit.object];
      const int x = static_cast<int>(i) % view.camera.width,
                y = static_cast<int>(i) / view.camera.width;
      if (!object.receives || at.lit.color.at(x, y) == at.unlit.color.at(x, y)) continue;
      truth[i] = sample.shadow.blocked ? 1.0f : 0.0f;
      ++tested;
      in_shadow += sample.shadow.blocked;
    }
  }

  /// Of a picture with shadows, the part of the light that is missing.
  void find_dark(const Buffers& drawn, raster::DepthFormat format, ShadowShot& shot) {
    const Bare& at = bare(format);
    dark.assign(truth.size(), 0.0f);
    for (int y = 0; y < view.camera.height; ++y) {
      for (int x = 0; x < view.camera.width; ++x) {
        const glm::vec4 color = drawn.color.at(x, y);
        for (int c = 0; c < 4; ++c) shot.not_finite += !std::isfinite(color[c]);
        const glm::vec4 unlit = at.unlit.color.at(x, y);
        const auto [channel, light] = strongest(at.lit.color.at(x, y), unlit);
        if (!(light > 0.0f)) continue;
        const float left = (color[channel] - unlit[channel]) / light;
        dark[static_cast<std::size_t>(y) * view.camera.width + x] =
            std::isfinite(left) ? std::clamp(1.0f - left, 0.0f, 1.0f) : 1.0f;
      }
    }
  }

  void compare(ShadowShot& shot) const {
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth[i] == kNotTested) continue;
      const double off = static_cast<double>(dark[i]) - truth[i];
      shot.wrong += std::abs(off);
      shot.too_dark += std::max(off, 0.0);
    }
    shot.tested = tested;
  }
};

ShadowTrial::ShadowTrial(View view, int threads)
    : impl_(std::make_unique<Impl>(std::move(view), threads)) {}
ShadowTrial::~ShadowTrial() = default;
ShadowTrial::ShadowTrial(ShadowTrial&&) noexcept = default;

const View& ShadowTrial::view() const { return impl_->view; }
std::size_t ShadowTrial::tested() const { return impl_->tested; }
std::size_t ShadowTrial::in_shadow() const { return impl_->in_shadow; }

ShadowShot ShadowTrial::measure(const ShadowSetting& setting) {
  Impl& at = *impl_;
  ShadowShot shot;
  Buffers buffers(at.view.camera, raster::ColorFormat::rgba32f, setting.depth);
  at.draw(buffers, at.with_casters(setting.occluder_triangles), setting);
  at.last_format = setting.depth;
  at.find_dark(buffers, setting.depth, shot);
  at.compare(shot);
  return shot;
}

ShadowShot ShadowTrial::measure_rays() {
  Impl& at = *impl_;
  at.dark.resize(at.truth.size());
  std::ranges::transform(at.truth, at.dark.begin(), [](float t) { return std::max(t, 0.0f); });
  at.last_format = raster::DepthFormat::d24;
  ShadowShot shot;
  at.compare(shot);
  return shot;
}

double ShadowTrial::frame_ms(const ShadowSetting& setting) {
  Impl& at = *impl_;
  const auto buffers = at.timed.try_emplace(setting.depth, at.view.camera,
                                            raster::ColorFormat::rgba8, setting.depth);
  return at.draw(buffers.first->second, at.with_casters(setting.occluder_triangles), setting);
}

double ShadowTrial::rays_ms() const {
  const Impl& at = *impl_;
  ar::Stopwatch watch;
  const RayReference rays(at.view.scene);
  cast_on_threads(rays, pipeline::pixel_rays(at.view.camera), at.view.scene.lights[0].position,
                  at.threads);
  return watch.lap_ms();
}

ar::Image ShadowTrial::picture() const {
  Impl& at = *impl_;
  const Impl::Bare& bare = at.bare(at.last_format);
  const pipeline::Camera& camera = at.view.camera;
  ar::Image out{camera.width, camera.height, 3, {}};
  for (int y = camera.height - 1; y >= 0; --y) {
    for (int x = 0; x < camera.width; ++x) {
      const float dark = at.dark[static_cast<std::size_t>(y) * camera.width + x];
      const glm::vec4 lit = bare.lit.color.at(x, y), unlit = bare.unlit.color.at(x, y);
      for (int c = 0; c < 3; ++c)
        out.pixels.push_back(to_byte(unlit[c] + (1.0f - dark) * (lit[c] - unlit[c])));
    }
  }
  return out;
}

ar::Image ShadowTrial::difference() const {
  const Impl& at = *impl_;
  const pipeline::Camera& camera = at.view.camera;
  ar::Image out = picture();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * camera.width + x;
      std::uint8_t* pixel = out.at(x, camera.height - 1 - y);
      const int grey = (pixel[0] + pixel[1] + pixel[2]) / 9;
      const float off = at.truth[i] == kNotTested ? 0.0f : at.dark[i] - at.truth[i];
      const auto shown = static_cast<std::uint8_t>(grey);
      const auto strong =
          static_cast<std::uint8_t>(std::lround(shown + std::abs(off) * (255.0f - shown)));
      pixel[0] = off > 0.0f ? strong : shown;
      pixel[1] = shown;
      pixel[2] = off < 0.0f ? strong : shown;
    }
  }
  return out;
}

}  // namespace gnomon::apps::study
