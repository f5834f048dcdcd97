#include "ar/fit_settings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace gnomon::ar {

namespace {

using Setter = std::function<void(FitScene&, double)>;

/// An item whose options are numbers: those of the ladder below the exact one, the given one, and
/// the exact one. `exact_name` is said in place of an exact number without meaning.
FitItem number_item(std::string name, std::string unit, std::set<double> ladder, double given,
                    double exact, const std::string& exact_name, const Setter& set) {
  FitItem item{
      .name = std::move(name), .unit = std::move(unit), .options = {}, .given = 0, .object = {}};
  ladder.insert(std::min(given, exact));
  ladder.insert(exact);
  for (const double value : ladder) {
    if (value > exact) break;
    if (value == std::min(given, exact)) item.given = item.options.size();
    item.options.push_back(
        {value == exact && !exact_name.empty() ? exact_name : fmt::format("{:g}", value), value,
         [set, value](FitScene& scene) { set(scene, value); }});
  }
  return item;
}

DifferentialSettings& settings_of(FitScene& scene) { return scene.file.differential->settings; }

FitItem counting_item(const FitScene& given) {
  const auto with = [](ShadowMethod method) {
    return [method](FitScene& scene) { scene.file.shadow.method = method; };
  };
  return {.name = "counting of volumes",
          .unit = "",
          .options = {{"zpass", 0.0, with(ShadowMethod::zpass)},
                      {"zfail", 0.0, with(ShadowMethod::zfail)},
                      {"auto", 0.0, with(ShadowMethod::automatic)}},
          .given = given.file.shadow.method == ShadowMethod::zpass   ? 0u
                   : given.file.shadow.method == ShadowMethod::zfail ? 1u
                                                                     : 2u,
          .object = {}};
}

FitItem length_item(const FitScene& given) {
  FitItem item{.name = "length of volumes", .unit = "", .options = {}, .given = 0, .object = {}};
  std::vector<std::pair<std::string, VolumeReach>> reaches;
  for (const double radius_m : {0.25, 0.5, 1.0, 2.0, 4.0})
    reaches.emplace_back(fmt::format("{:g} m", radius_m), radius_m);
  if (const double* radius_m = std::get_if<double>(&given.file.shadow.volume))
    reaches.emplace_back(fmt::format("as given, {:g} m", *radius_m), *radius_m);
  reaches.emplace_back("infinite", InfiniteReach{});
  reaches.emplace_back("auto", AutomaticReach{});
  for (auto& [name, reach] : reaches) {
    if (reach == given.file.shadow.volume) item.given = item.options.size();
    item.options.push_back(
        {name, 0.0, [reach = reach](FitScene& scene) { scene.file.shadow.volume = reach; }});
  }
  return item;
}

/// Sets what finds the light's shadows wherever something casts them.
std::function<void(FitScene&)> light_method(const std::string& light, pipeline::ShadowMethod method,
                                            const pipeline::MapSettings& map) {
  return [light, method, map](FitScene& scene) {
    for (SceneCaster& caster : scene.file.casters) {
      if (caster.light != light || caster.method == pipeline::ShadowMethod::none) continue;
      caster.method = method;
      caster.map = map;
    }
  };
}

FitItem light_item(const FitScene& given, const std::string& light) {
  FitItem item{.name = fmt::format("shadows of light '{}'", light),
               .unit = "",
               .options = {},
               .given = 0,
               .object = {}};
  for (const int size : {128, 256, 512, 1024, 2048, 4096}) {
    pipeline::MapSettings map;
    map.size = size;
    item.options.push_back({fmt::format("map of {0}x{0}", size), 0.0,
                            light_method(light, pipeline::ShadowMethod::map, map)});
  }
  item.options.push_back(
      {"alias-free map", 0.0, light_method(light, pipeline::ShadowMethod::alias_free, {})});
  // Tables may mix methods; what the scene came with is an option as a whole.
  std::vector<SceneCaster> own;
  for (const SceneCaster& caster : given.file.casters)
    if (caster.light == light) own.push_back(caster);
  const bool by_volumes = std::ranges::all_of(own, [](const SceneCaster& caster) {
    return caster.method == pipeline::ShadowMethod::volumes ||
           caster.method == pipeline::ShadowMethod::none;
  });
  item.given = item.options.size();
  if (!by_volumes)
    item.options.push_back({"as given", 0.0, [light, own](FitScene& scene) {
                              std::size_t at = 0;
                              for (SceneCaster& caster : scene.file.casters)
                                if (caster.light == light) caster = own[at++];
                            }});
  item.options.push_back(
      {"volumes", 0.0, light_method(light, pipeline::ShadowMethod::volumes, {})});
  return item;
}

FitItem light_samples_item(const FitScene& given, std::size_t i) {
  const pipeline::Light& light = given.file.lights[i];
  return number_item(fmt::format("points of light '{}'", light.name), "points",
                     {1, 2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 256, 512}, light.samples,
                     light.samples, "", [i](FitScene& scene, double value) {
                       scene.file.lights[i].samples = static_cast<int>(value);
                     });
}

FitItem precision_item(const FitScene& given) {
  using pipeline::ShadowPrecision;
  FitItem item{.name = "precision", .unit = "steps", .options = {}, .given = 0, .object = {}};
  std::vector<std::pair<const char*, ShadowPrecision>> all{{"bytes", ShadowPrecision::bytes},
                                                           {"dithered", ShadowPrecision::dithered},
                                                           {"values", ShadowPrecision::values}};
  const ShadowPrecision own = given.file.differential->settings.method.take.precision;
  if (own == ShadowPrecision::radiance) all = {{"radiance", own}};
  for (const auto& [name, precision] : all) {
    if (precision == own) item.given = item.options.size();
    item.options.push_back(
        {name, static_cast<double>(item.options.size()), [precision = precision](FitScene& scene) {
           settings_of(scene).method.take.precision = precision;
         }});
  }
  return item;
}

/// The larger, the fewer shafts there are.
FitItem prune_item(const FitScene& given) {
  FitItem item{.name = "light below which shafts are not cut",
               .unit = "",
               .options = {},
               .given = 0,
               .object = {}};
  const double own = given.file.differential->settings.light.prune_share;
  std::set<double, std::greater<>> shares{0.2, 0.1, 0.05, 0.02, 0.01, 0.0};
  shares.insert(own);
  for (const double share : shares) {
    if (share == own) item.given = item.options.size();
    item.options.push_back({fmt::format("{:g}", share), share, [share](FitScene& scene) {
                              settings_of(scene).light.prune_share = share;
                            }});
  }
  return item;
}

FitItem mask_item(const FitScene& given) {
  FitItem item{.name = "each source's shadow", .unit = "", .options = {}, .given = 0, .object = {}};
  const pipeline::DifferentialOptions& method = given.file.differential->settings.method;
  const bool by_map = method.mask == pipeline::ShadowMask::map;
  std::set<int> sizes{64, 128, 256, 512};
  if (by_map) sizes.insert(method.map_size);
  for (const int size : sizes) {
    if (by_map && size == method.map_size) item.given = item.options.size();
    item.options.push_back({fmt::format("map of {0}x{0}", size), 0.0, [size](FitScene& scene) {
                              settings_of(scene).method.mask = pipeline::ShadowMask::map;
                              settings_of(scene).method.map_size = size;
                            }});
  }
  if (!by_map) item.given = item.options.size();
  item.options.push_back({"volumes", 0.0, [](FitScene& scene) {
                            settings_of(scene).method.mask = pipeline::ShadowMask::volumes;
                          }});
  return item;
}

/// One number for the scene, as its file has it; models of their own are an option as a whole.
FitItem occluders_item(const FitScene& given) {
  const auto bound_to = [](std::size_t triangles) {
    return [triangles](FitScene& scene) {
      for (FitObject& object : scene.objects) object.models.shadow_model = nullptr;
      settings_of(scene).occluder_triangles = triangles;
    };
  };
  std::size_t largest = 0, most_given = 0;
  bool has_own = false;
  const std::size_t bound = given.file.differential->settings.occluder_triangles;
  for (std::size_t i = 0; i < given.objects.size(); ++i) {
    if (given.file.objects[i].role != pipeline::Role::virtual_object) continue;
    const ObjectModels& models = given.objects[i].models;
    largest = std::max(largest, triangle_count(*models.model));
    has_own = has_own || models.shadow_model;
    const std::size_t casting =
        triangle_count(models.shadow_model ? *models.shadow_model : *models.model);
    most_given = std::max(most_given,
                          models.shadow_model || bound == 0 ? casting : std::min(casting, bound));
  }
  FitItem item{.name = "occluders", .unit = "triangles", .options = {}, .given = 0, .object = {}};
  const auto as_given = [&] {
    item.given = item.options.size();
    std::vector<ObjectModels> models;
    for (const FitObject& object : given.objects) models.push_back(object.models);
    item.options.push_back({fmt::format("as given, {}", most_given),
                            static_cast<double>(most_given), [models, bound](FitScene& scene) {
                              for (std::size_t i = 0; i < models.size(); ++i)
                                scene.objects[i].models = models[i];
                              settings_of(scene).occluder_triangles = bound;
                            }});
  };
  bool added = !has_own && most_given == largest;
  for (double wanted = 12.0; wanted < static_cast<double>(largest); wanted *= 2.0) {
    const auto count = static_cast<std::size_t>(wanted);
    if (!added && count >= most_given) {
      as_given();
      added = true;
    }
    if (count != most_given || has_own)
      item.options.push_back({fmt::format("{}", count), wanted, bound_to(count)});
  }
  if (!added) as_given();
  if (!has_own && most_given == largest) item.given = item.options.size();
  item.options.push_back({"all", static_cast<double>(largest), bound_to(0)});
  return item;
}

}  // namespace

FitItem samples_item(const FitScene& given) {
  FitItem item{
      .name = "pixels drawn for one", .unit = "a side", .options = {}, .given = 0, .object = {}};
  // 0 is what the lens needs: at most 4, and 1 with differential shadows.
  const int exact = given.file.samples, most = exact != 0 ? exact : 4;
  const bool one_already = exact == 0 && given.file.differential.has_value();
  for (int samples = 1; samples < most && !one_already; ++samples)
    item.options.push_back({fmt::format("{0}x{0}", samples), static_cast<double>(samples),
                            [samples](FitScene& scene) { scene.file.samples = samples; }});
  item.given = item.options.size();
  item.options.push_back({"as given", static_cast<double>(most),
                          [exact](FitScene& scene) { scene.file.samples = exact; }});
  return item;
}

std::vector<FitItem> volume_items(const FitScene& given, bool photographs) {
  std::vector<FitItem> items;
  for (std::size_t i = 0; i < given.file.lights.size(); ++i) {
    if (!photographs) items.push_back(light_item(given, given.file.lights[i].name));
    if (given.file.lights[i].samples > 1) items.push_back(light_samples_item(given, i));
  }
  items.push_back(counting_item(given));
  items.push_back(length_item(given));
  return items;
}

std::vector<FitItem> differential_items(const FitScene& given, std::size_t passes) {
  const DifferentialSettings& settings = given.file.differential->settings;
  std::vector<FitItem> items;
  items.push_back(number_item("sources", "of all power", {0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95},
                              settings.light.transfer.power_share, 1.0, "every patch",
                              [](FitScene& scene, double value) {
                                settings_of(scene).light.transfer.power_share = value;
                              }));
  std::set<double> counts;
  for (double count = 1.0; count < static_cast<double>(passes); count = std::ceil(count * 1.5))
    counts.insert(count);
  items.push_back(
      number_item("passes", "passes", counts, static_cast<double>(settings.method.take.passes),
                  static_cast<double>(std::max<std::size_t>(passes, 1)), "one a source",
                  [](FitScene& scene, double value) {
                    settings_of(scene).method.take.passes = static_cast<std::size_t>(value);
                  }));
  items.push_back(occluders_item(given));
  items.push_back(precision_item(given));
  items.push_back(prune_item(given));
  items.push_back(mask_item(given));
  return items;
}

}  // namespace gnomon::ar
