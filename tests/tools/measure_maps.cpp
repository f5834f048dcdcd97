// Shadow maps against rays: sizes, and the two numbers of the offset. Prints the tables of
// docs/kuehl.md in Markdown. Usage: measure_maps
//
// Twenty random scenes of closed bodies above a plate (tests/pipeline/test_meshes.h), 320x240, each
// with a light that one map can serve. Of the pixels that face the light: dark ones that Embree
// sees lit (acne and what a shadow is too wide), lit ones that it sees in shadow (detachment and
// what it is too narrow). The time is the median of one execution's map pass and lit pass.
#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "ar/stopwatch.h"
#include "pipeline/general_method.h"
#include "pipeline/ray_reference.h"
#include "raster/execute.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon {
namespace {

using namespace pipeline;

constexpr int kScenes = 20, kWidth = 320, kHeight = 240;

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

/// Milliseconds of the execution.
double draw(Buffers& buffers, MapMemory& maps, Scene scene, const Camera& camera,
            ShadowMethod method, const MapSettings& settings) {
  scene.lights[0].shadow = method;
  scene.lights[0].map = settings;
  const raster::Frame frame = record_general(
      scene, camera, {&buffers.color, &buffers.depth, &buffers.stencil}, {.maps = &maps});
  ar::Stopwatch timer;
  raster::execute(frame);
  return timer.lap_ms();
}

struct Sum {
  std::size_t tested = 0, dark = 0, light = 0;
  std::vector<double> times_ms;
  /// Of each scene.
  std::vector<std::size_t> wrong;

  double median_ms() {
    std::sort(times_ms.begin(), times_ms.end());
    return times_ms[times_ms.size() / 2];
  }
};

Sum measure(const std::vector<View>& views, const MapSettings& settings) {
  Sum sum;
  Buffers lit, mapped;
  MapMemory maps;
  for (const View& view : views) {
    draw(lit, maps, view.scene, view.camera, ShadowMethod::none, settings);
    // The second time memory is warm.
    for (int i = 0; i < 2; ++i) {
      const double ms = draw(mapped, maps, view.scene, view.camera, ShadowMethod::map, settings);
      if (i == 1) sum.times_ms.push_back(ms);
    }
    const std::size_t before = sum.dark + sum.light;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto& sample = view.samples[static_cast<std::size_t>(y) * kWidth + x];
        if (!sample.hit.hit || sample.shadow.faces_away) continue;
        if (mapped.depth.at(x, y) == mapped.depth.max_value()) continue;
        ++sum.tested;
        const bool dark = mapped.color.at(x, y) != lit.color.at(x, y);
        sum.dark += dark && !sample.shadow.blocked;
        sum.light += !dark && sample.shadow.blocked;
      }
    }
    sum.wrong.push_back(sum.dark + sum.light - before);
  }
  return sum;
}

void print(const std::string& name, Sum sum) {
  std::printf("| %s | %zu | %zu | %.3f %% | %.2f |\n", name.c_str(), sum.dark, sum.light,
              100.0 * static_cast<double>(sum.dark + sum.light) / static_cast<double>(sum.tested),
              sum.median_ms());
  std::fflush(stdout);
}

void heading(const char* what) {
  std::printf("\n| %s | too dark | too light | wrong | ms |\n| --- | --- | --- | --- | --- |\n",
              what);
}

std::vector<View> make_views() {
  std::mt19937 random(2005);
  std::vector<View> views;
  while (views.size() < kScenes) {
    View view{.scene = test::random_scene(random)};
    if (view.scene.lights[0].position.w != 0.0f) view.scene.lights[0].position.y += 6.0f;
    view.camera = test::look({2.0f, 4.0f, 4.0f}, glm::vec3(0.0f), kWidth, kHeight);
    if (!plan_shadow_map(view.scene, view.scene.lights[0], view.camera, {})) continue;
    const RayReference rays(view.scene);
    view.samples = rays.cast(pixel_rays(view.camera), view.scene.lights[0].position);
    views.push_back(std::move(view));
  }
  return views;
}

void run() {
  const std::vector<View> views = make_views();
  std::printf("%zu pixels\n", measure(views, {}).tested);
  heading("size");
  for (const int size : {64, 128, 256, 512, 1024, 2048})
    print(std::to_string(size), measure(views, {.size = size}));
  print("found", measure(views, {}));
  heading("size, filter 2x2 (dark: less than wholly lit)");
  for (const int size : {256, 1024})
    print(std::to_string(size), measure(views, {.size = size, .filter = raster::Filter::linear}));
  const Sum found = measure(views, {.size = 512});
  std::vector<std::size_t> best = found.wrong;
  const auto sweep = [&](const char* format, float value, const raster::PolygonOffset& offset) {
    char name[32];
    std::snprintf(name, sizeof name, format, static_cast<double>(value));
    const Sum sum = measure(views, {.size = 512, .offset = offset});
    for (std::size_t i = 0; i < best.size(); ++i) best[i] = std::min(best[i], sum.wrong[i]);
    print(name, sum);
  };
  heading("offset scale, at size 512, units as found");
  const float units =
      plan_shadow_map(views[0].scene, views[0].scene.lights[0], views[0].camera, {.size = 512})
          ->offset.units;
  for (const float factor : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f, 1.25f, 1.5f, 2.0f, 4.0f, 8.0f})
    sweep("%.2f", factor, {factor, units});
  print("found", found);
  heading("offset units of D24, at size 512, scale 1");
  for (const float u : {0.0f, 10.0f, 100.0f, 1e3f, 1e4f, 1e5f, 1e6f}) sweep("%.0f", u, {1.0f, u});
  std::size_t near = 0;
  for (std::size_t i = 0; i < best.size(); ++i) near += found.wrong[i] * 10 <= best[i] * 11;
  std::printf("\nwithin a tenth of the best offset of its sweeps: %zu of %zu scenes\n", near,
              best.size());
}

}  // namespace
}  // namespace gnomon

int main() { gnomon::run(); }
