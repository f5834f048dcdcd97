// Shadow maps, alias-free maps and volumes against rays: sizes, and the two numbers of the offset.
// Prints what docs/kuehl.md has in its tables, and times, in Markdown. Usage: measure_maps
//
// Twenty random scenes of closed bodies above a plate (tests/pipeline/test_meshes.h), 320x240, each
// with a light that one map can serve. Of the pixels that the light reaches or would reach: dark
// ones that Embree sees lit (acne and what a shadow is too wide), lit ones that it sees in shadow
// (detachment and what it is too narrow); of both, those that no edge and no depth tie explains
// (tests/pipeline/stencil_check.h). A time is the scenes' median of recording and executing the
// whole frame on one thread, the least of five each.
#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "ar/stopwatch.h"
#include "pipeline/general_method.h"
#include "pipeline/ray_reference.h"
#include "raster/execute.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon {
namespace {

using namespace pipeline;

constexpr int kScenes = 20, kWidth = 320, kHeight = 240;
constexpr int kTimes = 5;

struct View {
  Scene scene;
  Camera camera;
  std::vector<RayReference::Sample> samples;
};

struct Buffers {
  raster::ColorBuffer color{kWidth, kHeight, raster::ColorFormat::rgba32f};
  raster::DepthBuffer depth{kWidth, kHeight};
  raster::StencilBuffer stencil{kWidth, kHeight};
};

struct Memory {
  TopologyCache topologies;
  VolumeMemory volumes;
  MapMemory maps;
  AliasFreeMemory alias_free;
  raster::ExecuteMemory executing;
};

/// Milliseconds of recording and executing.
double draw(Buffers& buffers, Memory& memory, Scene scene, const Camera& camera,
            ShadowMethod method, const MapSettings& settings) {
  scene.lights[0].shadow = method;
  scene.lights[0].map = settings;
  ar::Stopwatch timer;
  const raster::Frame frame =
      record_general(scene, camera, {&buffers.color, &buffers.depth, &buffers.stencil},
                     {.topologies = &memory.topologies,
                      .volumes = &memory.volumes,
                      .maps = &memory.maps,
                      .alias_free = &memory.alias_free,
                      .threads = 1});
  raster::execute(frame, {.threads = 1, .memory = &memory.executing});
  return timer.lap_ms();
}

struct Sum {
  std::size_t tested = 0, dark = 0, light = 0, unexplained = 0;
  std::vector<double> times_ms;
  /// Of each scene.
  std::vector<std::size_t> wrong;

  double median_ms() {
    std::sort(times_ms.begin(), times_ms.end());
    return times_ms[times_ms.size() / 2];
  }
};

/// Adds a view's pixels, but those to which the light adds nothing, shadow or not: a round body's
/// normals may be turned from it where its triangles are not.
void compare(const View& view, const Buffers& unlit, const Buffers& lit, const Buffers& drawn,
             Sum& sum) {
  const glm::vec4 light = view.scene.lights[0].position;
  const RayReference rays(view.scene);
  const std::size_t before = sum.dark + sum.light;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto& sample = view.samples[static_cast<std::size_t>(y) * kWidth + x];
      if (!sample.hit.hit || sample.shadow.faces_away) continue;
      const std::uint32_t depth = drawn.depth.at(x, y);
      if (depth == drawn.depth.max_value() || lit.color.at(x, y) == unlit.color.at(x, y)) continue;
      ++sum.tested;
      const bool dark = drawn.color.at(x, y) != lit.color.at(x, y);
      if (dark == sample.shadow.blocked) continue;
      ++(dark ? sum.dark : sum.light);
      sum.unexplained +=
          test::why(view.scene, rays, view.camera, light, x, y, depth, dark) == test::Reason::none;
    }
  }
  sum.wrong.push_back(sum.dark + sum.light - before);
}

/// `settings_of` gives each view's settings.
template <class SettingsOf>
Sum measure_each(const std::vector<View>& views, ShadowMethod method, SettingsOf settings_of) {
  Sum sum;
  Buffers unlit, lit, drawn;
  Memory memory;
  for (const View& view : views) {
    const MapSettings settings = settings_of(view);
    Scene dark = view.scene;
    dark.lights[0].color = glm::vec3(0.0f);
    draw(unlit, memory, dark, view.camera, ShadowMethod::none, settings);
    draw(lit, memory, view.scene, view.camera, ShadowMethod::none, settings);
    double least_ms = draw(drawn, memory, view.scene, view.camera, method, settings);
    for (int i = 1; i < kTimes; ++i)
      least_ms = std::min(least_ms, draw(drawn, memory, view.scene, view.camera, method, settings));
    sum.times_ms.push_back(least_ms);
    compare(view, unlit, lit, drawn, sum);
  }
  return sum;
}

Sum measure(const std::vector<View>& views, const MapSettings& settings,
            ShadowMethod method = ShadowMethod::map) {
  return measure_each(views, method, [&](const View&) { return settings; });
}

void print(const std::string& name, Sum sum) {
  std::printf("| %s | %zu | %zu | %.3f %% | %zu | %.2f |\n", name.c_str(), sum.dark, sum.light,
              100.0 * static_cast<double>(sum.dark + sum.light) / static_cast<double>(sum.tested),
              sum.unexplained, sum.median_ms());
  std::fflush(stdout);
}

void heading(const char* what) {
  std::printf(
      "\n| %s | too dark | too light | wrong | unexplained | ms |\n"
      "| --- | --- | --- | --- | --- | --- |\n",
      what);
}

std::vector<View> make_views() {
  std::mt19937 random(2005);
  std::vector<View> views;
  while (views.size() < kScenes) {
    View view{.scene = test::random_scene(random)};
    if (view.scene.lights[0].position.w != 0.0f) view.scene.lights[0].position.y += 6.0f;
    view.camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
    const auto plan =
        plan_shadow_map(view.scene, Casters(view.scene), view.scene.lights[0], view.camera, {});
    if (!plan || plan->empty) continue;
    const RayReference rays(view.scene);
    view.samples = rays.cast(pixel_rays(view.camera), view.scene.lights[0].position);
    views.push_back(std::move(view));
  }
  return views;
}

void run() {
  const std::vector<View> views = make_views();
  std::printf("%zu pixels\n", measure(views, {}).tested);
  heading("size, or method");
  for (const int size : {64, 128, 256, 512, 1024, 2048})
    print(std::to_string(size), measure(views, {.size = size}));
  print("found", measure(views, {}));
  print("alias-free", measure(views, {}, ShadowMethod::alias_free));
  print("volumes", measure(views, {}, ShadowMethod::volumes));
  print("no shadows", measure(views, {}, ShadowMethod::none));
  heading("size, filter 2x2 (dark: less than wholly lit)");
  for (const int size : {256, 1024})
    print(std::to_string(size), measure(views, {.size = size, .filter = raster::Filter::linear}));
  const Sum found = measure(views, {.size = 512});
  std::vector<std::size_t> best = found.wrong;
  const auto sweep = [&](const std::string& name, const Sum& sum) {
    for (std::size_t i = 0; i < best.size(); ++i) best[i] = std::min(best[i], sum.wrong[i]);
    print(name, sum);
  };
  heading("displace scale at size 512, offset as found");
  for (const char* scale : {"0", "0.25", "0.5", "0.75", "1", "1.25", "1.5", "2", "4", "8"})
    sweep(scale, measure_each(views, ShadowMethod::map, [&](const View& view) {
            MapSettings settings{.size = 512};
            settings.offset = plan_shadow_map(view.scene, Casters(view.scene), view.scene.lights[0],
                                              view.camera, settings)
                                  ->offset;
            settings.offset->factor = std::stof(scale);
            return settings;
          }));
  print("found", found);
  heading("offset at size 512, scale 1, in units of D24");
  for (const char* units : {"0", "1000", "10000", "100000", "1000000"})
    sweep(units,
          measure(views, {.size = 512, .offset = raster::PolygonOffset{1.0f, std::stof(units)}}));
  std::size_t near = 0;
  for (std::size_t i = 0; i < best.size(); ++i) near += found.wrong[i] * 10 <= best[i] * 11;
  std::printf("\nwithin a tenth of the best offset of its sweeps: %zu of %zu scenes\n", near,
              best.size());
}

}  // namespace
}  // namespace gnomon

int main() { gnomon::run(); }
