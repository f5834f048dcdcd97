#include "pipeline/general_method.h"

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/casters.h"
#include "pipeline/full_screen.h"
#include "pipeline/light_pass.h"
#include "pipeline/light_samples.h"
#include "pipeline/six_maps.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

using Lookup = std::optional<raster::DepthLookup>;

/// A light's maps: at most one of the two.
struct LightMaps {
  Lookup one;
  std::optional<std::array<Lookup, kCubeSides>> six;
};

class GeneralMethod {
 public:
  GeneralMethod(const Scene& scene, const Camera& camera, const raster::Targets& targets,
                const GeneralOptions& options)
      : scene_(scene),
        camera_(camera),
        targets_(targets),
        options_(options),
        objects_(
            place_objects(scene, camera, options.topologies ? *options.topologies : topologies_)),
        lights_(sample_lights(scene)),
        region_(near_region(camera.clip_from_world)),
        volume_options_(make_volume_options()),
        receivers_(receivers_for(volume_options_, scene)) {}

  raster::Frame record() {
    draw_ambient();
    for (const Light& light : lights_) add(light);
    return std::move(frame_);
  }

 private:
  VolumeOptions make_volume_options() const {
    return {.method = options_.method,
            .extrusion = options_.extrusion,
            .all_caps = options_.all_caps,
            .classical = options_.classical,
            .geometry = options_.geometry,
            .counts = options_.appendix_letter ? Counts::everywhere : options_.counts,
            .view = View{camera_.clip_from_world, targets_.width(), targets_.height(),
                         targets_.depth->format()},
            .threads = options_.threads,
            .memory = options_.volumes};
  }

  void draw_ambient() {
    frame_.begin_pass("ambient pass", targets_);
    frame_.clear({.color = options_.background, .depth = 1.0f, .stencil = 0});
    raster::State surface = surface_state();
    surface.depth = raster::DepthState{};
    for (const PlacedObject& object : objects_)
      draw_lit(frame_, object, scene_, camera_, {.ambient = true, .emission = true}, surface);
  }

  void begin(const char* label, const Light& light) {
    frame_.begin_pass(lights_.size() > 1 ? label + (": " + light.name) : label, targets_);
  }

  void add(const Light& light) {
    const Casters mapped(scene_, light, ShadowMethod::map);
    const Casters exact(scene_, light, ShadowMethod::alias_free);
    const std::optional<LightMaps> maps = draw_maps(light, mapped);
    std::vector<Casters> counted{Casters(scene_, light, ShadowMethod::volumes)};
    // What no map can show has volumes.
    if (!maps) counted.push_back(mapped);
    std::erase_if(counted, [](const Casters& casters) { return casters.empty(); });
    begin(!counted.empty() ? "shadow volumes"
          : exact.empty()  ? "no volumes"
                           : "alias-free shadows",
          light);
    frame_.clear({.stencil = 0});
    for (const Casters& casters : counted) count(light, casters);
    if (!exact.empty()) hide(light, exact);
    if (maps && maps->six)
      add_side_by_side(light, *maps->six);
    else
      add_at_once(light, maps ? maps->one : std::nullopt);
  }

  /// Absent: the light needs maps and cannot have them.
  std::optional<LightMaps> draw_maps(const Light& light, const Casters& casters) {
    LightMaps maps;
    if (casters.empty()) return maps;
    raster::require(options_.maps != nullptr, "shadow maps need memory");
    const MapSettings& settings = light.map;
    if (settings.sides != MapSides::six || light.position.w == 0.0f) {
      const auto plan = plan_shadow_map(scene_, casters, light, camera_, settings);
      if (plan) maps.one = draw_map(*plan, light, casters, light.name);
      if (plan || settings.sides == MapSides::one) return plan ? std::optional(maps) : std::nullopt;
    }
    const auto plans = plan_six_maps(scene_, casters, light, camera_, settings);
    maps.six.emplace();
    for (std::size_t side = 0; side < plans.size(); ++side)
      (*maps.six)[side] = draw_map(plans[side], light, casters,
                                   light.name + " " + cube_side_name(static_cast<int>(side)));
    return maps;
  }

  Lookup draw_map(const MapPlan& plan, const Light& light, const Casters& casters,
                  const std::string& name) {
    if (plan.empty) return {};
    raster::DepthBuffer& map = options_.maps->map(map_number_++, plan.size, light.map.format);
    return record_shadow_map(frame_, objects_, casters, name, plan, light.map.filter, map);
  }

  void count(const Light& light, const Casters& casters) {
    VolumeOptions options = volume_options_;
    options.casters = &casters;
    count_volumes(frame_, make_volumes(objects_, light, receivers_, region_, options),
                  {.appendix_letter = options_.appendix_letter,
                   .single_sided = options_.single_sided,
                   .in_batches = true,
                   .casters_drawn = !options_.all_caps,
                   .light_name = light.name});
  }

  /// After the counts: it saturates, so that no count comes back to 0.
  void hide(const Light& light, const Casters& casters) {
    AliasFreeMemory& memory = options_.alias_free ? *options_.alias_free : alias_free_;
    if (!std::exchange(has_points_, true))
      memory.finder.find(objects_, camera_, targets_.width(), targets_.height(),
                         targets_.depth->format(), options_.threads);
    stencil_hidden(frame_, find_hidden(objects_, casters, camera_, light, options_.threads, memory),
                   targets_.width(), targets_.height(), "hidden from " + light.name);
  }

  void add_at_once(const Light& light, const Lookup& shadow_map) {
    begin("lit pass", light);
    for (const PlacedObject& object : objects_)
      add_light(frame_, object, scene_, camera_, light, {.shadow_map = shadow_map});
  }

  /// Bit 7 of the stencil: in shadow, or lit already; bit 0: in the side's pyramid.
  void add_side_by_side(const Light& light, const std::array<Lookup, kCubeSides>& maps) {
    begin("lit pass", light);
    flag_counts(frame_);
    for (const PlacedObject& object : objects_)
      if (!object.object->receives) add_light(frame_, object, scene_, camera_, light);
    for (int side = 0; side < kCubeSides; ++side) {
      mark_side(frame_, light, camera_, side);
      const LightPassOptions options{.where = {.ref = kSideBit,
                                               .read_mask = kSideBit | kCounted,
                                               .write_mask = kCounted,
                                               .mark = raster::StencilOp::invert},
                                     .shadow_map = maps[static_cast<std::size_t>(side)]};
      for (const PlacedObject& object : objects_)
        if (object.object->receives) add_light(frame_, object, scene_, camera_, light, options);
    }
  }

  const Scene& scene_;
  const Camera& camera_;
  const raster::Targets& targets_;
  const GeneralOptions& options_;
  TopologyCache topologies_;
  const std::vector<PlacedObject> objects_;
  const std::vector<Light> lights_;
  const std::optional<NearRegion> region_;
  const VolumeOptions volume_options_;
  const Receivers receivers_;
  raster::Frame frame_;
  std::size_t map_number_ = 0;
  AliasFreeMemory alias_free_;
  bool has_points_ = false;
};

}  // namespace

raster::Frame record_general(const Scene& scene, const Camera& camera,
                             const raster::Targets& targets, const GeneralOptions& options) {
  raster::require(targets.color && targets.depth && targets.stencil,
                  "the general method needs colour, depth and stencil");
  return GeneralMethod(scene, camera, targets, options).record();
}

}  // namespace gnomon::pipeline
