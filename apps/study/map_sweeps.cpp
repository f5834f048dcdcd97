#include "apps/study/map_sweeps.h"

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

/// Closed and thick, thin, and open ones under a lamp: what a map's bias serves differs.
View bodies_under_a_lamp(std::size_t input) {
  Scene scene = ground_under({1.5f, 4.0f, 1.0f, 1.0f});
  add_object(scene, "torus", model_of(torus_mesh(0.6f, 0.22f, 48, 24)),
             placed({-0.9f, 0.9f, 0.2f}, {1.0f, 0.0f, 0.3f}, 0.9f));
  add_object(scene, "ball", model_of(icosphere_mesh(0.45f, 4)), placed({0.6f, 0.7f, -0.3f}));
  add_object(scene, "box", model_of(flat_box_mesh({0.3f, 0.4f, 0.25f})),
             placed({0.4f, 0.4f, 1.1f}, {0.0f, 1.0f, 0.0f}, 0.6f));
  add_object(scene, "plate", model_of(flat_box_mesh({0.5f, 0.02f, 0.3f})),
             placed({-0.6f, 1.9f, -0.6f}, {0.4f, 0.0f, 1.0f}, 0.3f));
  add_object(scene, "sheet", model_of(square_mesh(0.4f)),
             placed({0.9f, 0.3f, 0.5f}, {0.0f, 0.0f, 1.0f}, 0.3f));
  return {"", std::move(scene), look_from_side(input, {0.0f, 0.5f, 0.0f}, 4.5f)};
}

/// One map or six, hard or filtered, of 24 bits or 16. `texels` is a part of the names.
std::vector<ShadowSetting> one_map_and_six(int size, const std::string& texels) {
  std::vector<ShadowSetting> out{map("map" + texels, size)};
  out.emplace_back(map("map" + texels + ", 2x2 filter", size)).map.filter = raster::Filter::linear;
  out.emplace_back(map("map" + texels + ", D16", size)).map.format = raster::DepthFormat::d16;
  ShadowSetting& six = out.emplace_back(map("six maps" + texels, size));
  six.map.sides = MapSides::six;
  ShadowSetting& filtered = out.emplace_back(map("six maps" + texels + ", 2x2 filter", size));
  filtered.map.sides = MapSides::six;
  filtered.map.filter = raster::Filter::linear;
  return out;
}

/// What has no such setting.
void add_others(std::vector<ShadowSetting>& out) {
  out.push_back(map("map, all found", 0));
  out.push_back(alias_free());
  out.push_back(volumes("automatic volumes", VolumeMethod::automatic, false));
}

bool is_set(const ShadowSetting& setting) {
  return setting.method == ShadowMethod::map && setting.map.size;
}

TrialSweep::Plan map_plan(SweepText text, std::vector<std::string> values,
                          std::vector<ShadowSetting> settings,
                          std::function<void(std::size_t, MapSettings&)> set) {
  TrialSweep::Plan plan;
  plan.text = std::move(text);
  plan.text.measure = kWrongPixels;
  plan.text.oracle = kRays;
  plan.text.explanation +=
      " Closed, thin and open bodies under a lamp, from four sides. Beside them the map whose "
      "settings are found, the alias-free map and volumes.";
  plan.values = std::move(values);
  plan.inputs = 4;
  plan.settings = std::move(settings);
  add_others(plan.settings);
  plan.view = [](std::size_t, std::size_t input) { return bodies_under_a_lamp(input); };
  plan.adapt = [set = std::move(set)](std::size_t value, ShadowSetting& setting) {
    if (is_set(setting)) set(value, setting.map);
  };
  return plan;
}

constexpr std::array kSizes = {4096, 2048, 1024, 512, 256, 128, 64, 32, 16, 4, 1};

TrialSweep::Plan smaller() {
  std::vector<std::string> values;
  for (const int size : kSizes) values.push_back(std::to_string(size));
  return map_plan({"map-size", "Maps have few texels",
                   "All else of the maps is found. A filtered map's soft edge counts by how far it "
                   "is from the rays' hard one.",
                   "texels a side", "", ""},
                  std::move(values), one_map_and_six(1024, ""),
                  [](std::size_t value, MapSettings& map) { map.size = kSizes[value]; });
}

/// Settings of one map and of two sizes: the angle of view is one map's alone.
std::vector<ShadowSetting> wide_settings() {
  std::vector<ShadowSetting> out;
  for (const int size : {512, 2048}) {
    const std::string texels = "map " + std::to_string(size);
    out.push_back(map(texels, size));
    out.emplace_back(map(texels + ", 2x2 filter", size)).map.filter = raster::Filter::linear;
  }
  return out;
}

const std::vector<double> kWide = {0.7, 1, 1.4, 2, 4, 8, 16, 32, 100, 1000, 1e6};

TrialSweep::Plan wider() {
  return map_plan({"map-wide", "A map shows far more than the bodies",
                   "Maps of 512 and of 2048 texels. 0.7 holds all bodies.",
                   "tangent of half the angle of view", "", ""},
                  number_texts(kWide), wide_settings(), [](std::size_t value, MapSettings& map) {
                    map.fov_tangent = static_cast<float>(kWide[value]);
                  });
}

const std::vector<double> kNarrow = {0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.03, 0.01, 1e-6};

TrialSweep::Plan narrower() {
  return map_plan({"map-narrow", "A map shows a part of the bodies",
                   "Maps of 512 and of 2048 texels. What a map does not show is lit.",
                   "tangent of half the angle of view", "", ""},
                  number_texts(kNarrow), wide_settings(), [](std::size_t value, MapSettings& map) {
                    map.fov_tangent = static_cast<float>(kNarrow[value]);
                  });
}

using Offsets = std::vector<raster::PolygonOffset>;

const Offsets kSmaller = {{1, 4}, {1, 2}, {0.5f, 2}, {0.5f, 0}, {0.25f, 0},  {0.1f, 0},
                          {0, 2}, {0, 0}, {0, -2},   {-1, -4},  {-4, -1000}, {-100, -1e6f}};
const Offsets kLarger = {{1, 4},      {2, 16},      {4, 100},    {8, 1000},
                         {16, 1e4f},  {32, 1e5f},   {64, 3e5f},  {128, 1e6f},
                         {256, 3e6f}, {1000, 1e7f}, {1e4f, 1e8f}};

TrialSweep::Plan biased(SweepText text, const Offsets& offsets) {
  std::vector<std::string> values;
  for (const raster::PolygonOffset& offset : offsets)
    values.push_back(fmt::format("{:g}, {:g}", offset.factor, offset.units));
  return map_plan(std::move(text), std::move(values), one_map_and_six(512, " 512"),
                  [&offsets](std::size_t value, MapSettings& map) { map.offset = offsets[value]; });
}

TrialSweep::Plan less_bias() {
  return biased({"map-acne", "A map's bias is too small",
                 "Surfaces shadow themselves; each value is the polygon offset's factor (of the "
                 "depth's slope) and units (steps of the depth buffer).",
                 "factor, units", "", ""},
                kSmaller);
}

TrialSweep::Plan more_bias() {
  return biased({"map-detached", "A map's bias is too large",
                 "Shadows part from their casters and vanish; each value is the polygon offset's "
                 "factor (of the depth's slope) and units (steps of the depth buffer).",
                 "factor, units", "", ""},
                kLarger);
}

}  // namespace

void add_map_sweeps(Sweeps& sweeps, int threads) {
  for (TrialSweep::Plan (*plan)() : {smaller, wider, narrower, less_bias, more_bias})
    sweeps.push_back(std::make_unique<TrialSweep>(plan(), threads));
}

}  // namespace gnomon::apps::study
