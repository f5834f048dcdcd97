#include "apps/inspector/lab_frame.h"

#include <optional>
#include <utility>

#include "apps/inspector/lab_stage.h"
#include "pipeline/count_volumes.h"
#include "pipeline/light_pass.h"
#include "pipeline/make_volumes.h"
#include "pipeline/placed_object.h"

namespace gnomon::apps::inspector {

namespace {

using pipeline::PlacedVolume;

/// The volume without the caps that are not wanted.
std::shared_ptr<const pipeline::ShadowVolume> with_caps(const pipeline::ShadowVolume& whole,
                                                        bool front, bool back) {
  auto out = std::make_shared<pipeline::ShadowVolume>(whole);
  if (!back) out->indices.resize(whole.front_cap_indices + whole.side_indices);
  if (!front) {
    out->indices.erase(out->indices.begin(),
                       out->indices.begin() + static_cast<std::ptrdiff_t>(whole.front_cap_indices));
    out->front_cap_indices = 0;
  }
  return out;
}

pipeline::VolumeMethod counting(LabMethod method) {
  return method == LabMethod::zpass   ? pipeline::VolumeMethod::zpass
         : method == LabMethod::zfail ? pipeline::VolumeMethod::zfail
                                      : pipeline::VolumeMethod::automatic;
}

class Recorder {
 public:
  Recorder(const LabState& state, LabFrame& out)
      : state_(state),
        out_(out),
        objects_(pipeline::place_objects(out.scene, out.camera, topologies_)),
        targets_{&out.color, &out.depth, &out.stencil},
        lamp_(out.scene.lights.front()) {}

  void record() {
    draw_ambient();
    std::optional<raster::DepthLookup> map;
    if (state_.method == LabMethod::shadow_map)
      map = draw_map();
    else
      count();
    out_.frame.begin_pass("lit pass", targets_);
    for (const pipeline::PlacedObject& object : objects_)
      pipeline::add_light(out_.frame, object, out_.scene, out_.camera, lamp_, {.shadow_map = map});
  }

 private:
  void draw_ambient() {
    out_.frame.begin_pass("ambient pass", targets_);
    out_.frame.clear({.color = glm::vec4(0.16f, 0.18f, 0.22f, 1.0f), .depth = 1.0f, .stencil = 0});
    for (const pipeline::PlacedObject& object : objects_) draw_ambient(object);
  }

  /// Ambient light is one colour a material: flat, which is quick.
  void draw_ambient(const pipeline::PlacedObject& object) {
    raster::State surface = pipeline::surface_state();
    surface.depth = raster::DepthState{};
    surface.front_face = object.front_face;
    for (std::size_t i = 0; i < object.meshes.size(); ++i) {
      const raster::Material& material = object.object->model->parts[i].material;
      out_.frame.keep(object.meshes[i]);
      out_.frame.draw(
          {.state = surface,
           .mesh = object.meshes[i]->view(),
           .clip_from_model = object.clip_from_model,
           .shading = raster::Flat{.color = glm::vec4(material.ambient * out_.scene.ambient, 1.0f)},
           .label = object.object->name});
    }
  }

  /// Absent where no map can serve: the light is in the casters' midst, or nothing casts.
  std::optional<raster::DepthLookup> draw_map() {
    const pipeline::Casters casters(out_.scene);
    const auto plan = pipeline::plan_shadow_map(out_.scene, casters, lamp_, out_.camera, lamp_.map);
    if (!plan || plan->empty) return std::nullopt;
    raster::DepthBuffer& map = out_.maps.map(0, plan->size, lamp_.map.format);
    return pipeline::record_shadow_map(out_.frame, objects_, casters, lamp_.name, *plan,
                                       lamp_.map.filter, map);
  }

  void count() {
    const auto extrusion = state_.length_m > 0.0
                               ? pipeline::Extrusion{pipeline::Extrusion::Kind::radius,
                                                     static_cast<float>(state_.length_m)}
                               : pipeline::Extrusion{pipeline::Extrusion::Kind::infinite};
    std::vector<PlacedVolume> volumes = pipeline::make_volumes(
        objects_, lamp_, {}, pipeline::near_region(out_.camera.clip_from_world),
        {.method = counting(state_.method),
         .extrusion = extrusion,
         .all_caps = true,
         .classical = state_.classical_outline,
         .threads = 1});
    for (PlacedVolume& volume : volumes)
      volume.volume = with_caps(*volume.volume, state_.front_cap, state_.back_cap);
    out_.frame.begin_pass("shadow volumes", targets_);
    out_.frame.clear({.stencil = 0});
    pipeline::count_volumes(out_.frame, volumes,
                            {.appendix_letter = state_.saturate, .light_name = lamp_.name});
  }

  const LabState& state_;
  LabFrame& out_;
  pipeline::TopologyCache topologies_;
  const std::vector<pipeline::PlacedObject> objects_;
  const raster::Targets targets_;
  const pipeline::Light& lamp_;
};

}  // namespace

LabFrame::LabFrame(const LabState& state)
    : scene(lab_scene(state)),
      camera(lab_camera(state)),
      color(state.width, state.height),
      depth(state.width, state.height,
            state.depth_16_bits ? raster::DepthFormat::d16 : raster::DepthFormat::d24),
      stencil(state.width, state.height) {}

std::shared_ptr<LabFrame> record_lab(const LabState& state) {
  auto out = std::make_shared<LabFrame>(state);
  Recorder(state, *out).record();
  return out;
}

}  // namespace gnomon::apps::inspector
