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
#include "pipeline/modulative_method.h"
#include "pipeline/shadow_map.h"
#include "tests/pipeline/light_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon {
namespace {

using namespace pipeline;

constexpr int kScenes = 20, kWidth = 320, kHeight = 240;
constexpr int kTimes = 5;

struct View {
  Scene scene;
  Camera camera;
};

struct Sum {
  test::LightCheck check;
  std::vector<double> times_ms;
  /// Of each scene.
  std::vector<std::size_t> wrong;

  double median_ms() {
    std::sort(times_ms.begin(), times_ms.end());
    return times_ms[times_ms.size() / 2];
  }
};

/// `settings_of` gives each view's settings.
template <class SettingsOf>
Sum measure_each(const std::vector<View>& views, ShadowMethod method, SettingsOf settings_of) {
  Sum sum;
  test::LightMemory memory;
  for (const View& view : views) {
    const MapSettings settings = settings_of(view);
    double least_ms = 1e30;
    test::LightBuffers buffers(kWidth, kHeight);
    for (int i = 0; i < kTimes; ++i)
      least_ms = std::min(
          least_ms, test::draw_light(buffers, memory, view.scene, view.camera, method, settings));
    sum.times_ms.push_back(least_ms);
    const test::LightCheck check =
        test::check_light(memory, view.scene, view.camera, method, settings);
    sum.check += check;
    sum.wrong.push_back(check.dark + check.light);
  }
  return sum;
}

Sum measure(const std::vector<View>& views, const MapSettings& settings,
            ShadowMethod method = ShadowMethod::map) {
  return measure_each(views, method, [&](const View&) { return settings; });
}

void print(const std::string& name, Sum sum) {
  const test::LightCheck& check = sum.check;
  std::printf(
      "| %s | %zu | %zu | %.3f %% | %zu | %.2f |\n", name.c_str(), check.dark, check.light,
      100.0 * static_cast<double>(check.dark + check.light) / static_cast<double>(check.tested),
      check.unexplained, sum.median_ms());
  std::fflush(stdout);
}

void heading(const char* what) {
  std::printf(
      "\n| %s | too dark | too light | wrong | unexplained | ms |\n"
      "| --- | --- | --- | --- | --- | --- |\n",
      what);
}

/// The median of the scenes of the least milliseconds of recording and executing.
template <class Record>
double time_frames(const std::vector<View>& views, test::LightMemory& memory, Record record) {
  std::vector<double> times_ms;
  test::LightBuffers buffers(kWidth, kHeight);
  for (const View& view : views) {
    double least_ms = 1e30;
    for (int i = 0; i < kTimes; ++i) {
      ar::Stopwatch timer;
      const raster::Frame frame =
          record(view, raster::Targets{&buffers.color, &buffers.depth, &buffers.stencil});
      raster::execute(frame, {.threads = 1, .memory = &memory.executing});
      least_ms = std::min(least_ms, timer.lap_ms());
    }
    times_ms.push_back(least_ms);
  }
  std::sort(times_ms.begin(), times_ms.end());
  return times_ms[times_ms.size() / 2];
}

/// Every way of counting, and the two ways of darkening.
void time_volumes(const std::vector<View>& views) {
  test::LightMemory memory;
  std::puts("\n| volumes | ms |\n| --- | --- |");
  const auto print_time = [&](const char* name, const GeneralOptions& given) {
    GeneralOptions options = given;
    options.topologies = &memory.topologies;
    options.volumes = &memory.volumes;
    options.threads = 1;
    std::printf("| %s | %.2f |\n", name,
                time_frames(views, memory, [&](const View& view, const raster::Targets& targets) {
                  return record_general(view.scene, view.camera, targets, options);
                }));
    std::fflush(stdout);
  };
  constexpr Extrusion kInfinite{.kind = Extrusion::Kind::infinite};
  using enum VolumeMethod;
  print_time("automatic, at receivers", {.counts = Counts::at_receivers});
  print_time("automatic", {});
  print_time("z-pass to infinity", {.method = zpass, .extrusion = kInfinite});
  print_time("z-fail to infinity", {.method = zfail, .extrusion = kInfinite});
  print_time("z-pass, two single-sided passes",
             {.method = zpass, .extrusion = kInfinite, .single_sided = true});
  print_time("z-fail, two single-sided passes",
             {.method = zfail, .extrusion = kInfinite, .single_sided = true});
  print_time(
      "z-pass, degenerate quads",
      {.method = zpass, .extrusion = kInfinite, .geometry = VolumeGeometry::degenerate_quads});
  print_time(
      "z-fail, degenerate quads",
      {.method = zfail, .extrusion = kInfinite, .geometry = VolumeGeometry::degenerate_quads});
  std::printf("| automatic, modulative quad | %.2f |\n",
              time_frames(views, memory, [&](const View& view, const raster::Targets& targets) {
                return record_modulative(
                    view.scene, view.camera, targets,
                    {.topologies = &memory.topologies, .volumes = &memory.volumes, .threads = 1});
              }));
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
    views.push_back(std::move(view));
  }
  return views;
}

void run() {
  const std::vector<View> views = make_views();
  std::printf("%zu pixels\n", measure(views, {}).check.tested);
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
  print("six maps of 512", measure(views, {.sides = MapSides::six, .size = 512}));
  time_volumes(views);
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
