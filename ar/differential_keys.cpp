#include "ar/differential_keys.h"

#include <string>

#include <fmt/format.h>

#include "ar/toml_table.h"

namespace gnomon::ar {
namespace {

pipeline::ShadowPrecision read_precision(const TomlTable& t) {
  const std::string name = t.text("precision").value_or("bytes");
  if (name == "bytes") return pipeline::ShadowPrecision::bytes;
  if (name == "dithered") return pipeline::ShadowPrecision::dithered;
  if (name == "values") return pipeline::ShadowPrecision::values;
  if (name == "radiance") return pipeline::ShadowPrecision::radiance;
  t.fail("precision", fmt::format("'{}' is not one of bytes, dithered, values, radiance", name));
}

pipeline::ShadowMask read_mask(const TomlTable& t) {
  const std::string name = t.text("mask").value_or("volumes");
  if (name == "map") return pipeline::ShadowMask::map;
  if (name == "volumes") return pipeline::ShadowMask::volumes;
  t.fail("mask", fmt::format("'{}' is not one of map, volumes", name));
}

}  // namespace

DifferentialFile read_differential(const std::filesystem::path& file, const toml::table& table) {
  const TomlTable t(file, table, "[differential]",
                    {"lit_scene", "passes", "budget_ms", "precision", "mask", "map_size",
                     "self_shadows", "occluder_triangles", "power_share", "prune_share",
                     "drop_pruned", "whole_clusters", "returned_light", "by_share"});
  DifferentialFile out;
  // Absent, the command line names it.
  out.lit_scene = t.file("lit_scene").value_or("");
  DifferentialSettings& settings = out.settings;
  pipeline::ShadowTakeOptions& take = settings.method.take;
  if (t.has("passes") && t.has("budget_ms"))
    t.fail("budget_ms", "together with passes, which it finds: give one of them");
  if (const auto passes = t.integer("passes", 1, 100'000))
    take.passes = static_cast<std::size_t>(*passes);
  settings.budget_ms = t.number("budget_ms", 0.1, 60'000.0).value_or(0.0);
  take.precision = read_precision(t);
  take.whole_clusters = t.boolean("whole_clusters").value_or(take.whole_clusters);
  take.returned_light = t.boolean("returned_light").value_or(take.returned_light);
  take.by_share = t.boolean("by_share").value_or(take.by_share);
  settings.method.mask = read_mask(t);
  if (t.has("map_size") && settings.method.mask != pipeline::ShadowMask::map)
    t.fail("map_size", "is a shadow map's: give mask = \"map\" too");
  settings.method.map_size = t.integer("map_size", 8, 4096).value_or(settings.method.map_size);
  settings.method.self_shadows = t.boolean("self_shadows").value_or(settings.method.self_shadows);
  if (const auto triangles = t.integer("occluder_triangles", 0, 100'000'000)) {
    if (*triangles > 0 && *triangles < 4)
      t.fail("occluder_triangles", "a closed surface has 4 triangles or more; 0 takes all");
    settings.occluder_triangles = static_cast<std::size_t>(*triangles);
  }
  pipeline::LightPathOptions& light = settings.light;
  light.transfer.power_share =
      t.number("power_share", 0.0, 1.0).value_or(light.transfer.power_share);
  light.prune_share = t.number("prune_share", 0.0, 1.0).value_or(light.prune_share);
  light.drop_pruned = t.boolean("drop_pruned").value_or(light.drop_pruned);
  return out;
}

}  // namespace gnomon::ar
