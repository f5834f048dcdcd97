#include "apps/study/shadow_setting.h"

#include <utility>

namespace gnomon::apps::study {

using pipeline::Extrusion;
using pipeline::VolumeMethod;

ShadowSetting volumes(std::string name, VolumeMethod counting, bool infinite) {
  ShadowSetting setting{.name = std::move(name), .family = "volumes", .counting = counting};
  if (infinite) {
    setting.extrusion.kind = Extrusion::Kind::infinite;
    setting.counts = pipeline::Counts::everywhere;
  }
  return setting;
}

ShadowSetting map(std::string name, int size) {
  ShadowSetting setting{
      .name = std::move(name), .family = "maps", .method = pipeline::ShadowMethod::map};
  if (size > 0) setting.map.size = size;
  return setting;
}

ShadowSetting alias_free() {
  return {.name = "alias-free map",
          .family = "alias-free maps",
          .method = pipeline::ShadowMethod::alias_free};
}

namespace {

void add_volumes(std::vector<ShadowSetting>& out) {
  out.push_back(volumes("volumes, automatic", VolumeMethod::automatic, false));
  out.push_back(volumes("z-pass to infinity", VolumeMethod::zpass));
  out.push_back(volumes("z-fail to infinity", VolumeMethod::zfail));
  ShadowSetting& needed = out.emplace_back(volumes("z-fail, finite", VolumeMethod::zfail, false));
  needed.counts = pipeline::Counts::everywhere;
  ShadowSetting& single =
      out.emplace_back(volumes("z-fail, single-sided passes", VolumeMethod::zfail));
  single.single_sided = true;
  ShadowSetting& letter =
      out.emplace_back(volumes("z-pass, saturating (appendix A)", VolumeMethod::zpass));
  letter.appendix_letter = true;
  for (const auto& [name, counting] : {std::pair{"z-pass, degenerate quads", VolumeMethod::zpass},
                                       std::pair{"z-fail, degenerate quads", VolumeMethod::zfail}})
    out.emplace_back(volumes(name, counting)).geometry = pipeline::VolumeGeometry::degenerate_quads;
  ShadowSetting& classical =
      out.emplace_back(volumes("z-fail, closed manifolds only", VolumeMethod::zfail));
  classical.classical = true;
  ShadowSetting& d16 =
      out.emplace_back(volumes("volumes, automatic, D16", VolumeMethod::automatic, false));
  d16.depth = raster::DepthFormat::d16;
}

void add_maps(std::vector<ShadowSetting>& out) {
  for (const int size : {128, 256, 512, 1024, 2048})
    out.push_back(map("map " + std::to_string(size), size));
  for (const int size : {256, 512, 1024, 2048})
    out.emplace_back(map("map " + std::to_string(size) + ", 2x2 filter", size)).map.filter =
        raster::Filter::linear;
  out.push_back(map("map, size found", 0));
  out.emplace_back(map("map 512, D16", 512)).map.format = raster::DepthFormat::d16;
  out.emplace_back(map("six maps of 512", 512)).map.sides = pipeline::MapSides::six;
  out.push_back(alias_free());
}

}  // namespace

std::vector<ShadowSetting> charted_settings() {
  std::vector<ShadowSetting> out;
  add_volumes(out);
  add_maps(out);
  for (const std::size_t triangles : {500, 100, 20}) {
    ShadowSetting reduced =
        volumes("volumes, casters of " + std::to_string(triangles), VolumeMethod::automatic, false);
    reduced.family = "reduced casters";
    reduced.occluder_triangles = triangles;
    out.push_back(reduced);
  }
  out.push_back({.name = "no shadow", .family = "nothing", .method = pipeline::ShadowMethod::none});
  return out;
}

}  // namespace gnomon::apps::study
