#include "bench/volumes.h"

#include <memory>
#include <optional>

#include "pipeline/near_clip.h"
#include "pipeline/receivers.h"

namespace gnomon::bench {
namespace {

using pipeline::VolumeMethod;

/// The count on depth pass wants no caps where the eye is outside the volume: what pipeline records
/// for z-pass, on the sides alone.
void count_sides(raster::Frame& frame, const pipeline::PlacedVolume& volume) {
  frame.keep(volume.volume);
  raster::StencilFace front, back;
  front.pass = raster::StencilOp::incr_wrap;
  back.pass = raster::StencilOp::decr_wrap;
  raster::State state = pipeline::surface_state();
  state.depth = raster::DepthState{.func = raster::CompareFunc::less, .write = false};
  state.color = raster::ColorState::off();
  state.front_face = volume.front_face;
  state.stencil = raster::StencilState{front, back};
  frame.draw({.state = state, .mesh = counted(volume), .clip_from_model = volume.clip_from_model});
}

}  // namespace

std::vector<pipeline::PlacedVolume> make_volumes(const Subject& subject,
                                                 std::span<const pipeline::PlacedObject> objects,
                                                 Method method, int threads,
                                                 pipeline::VolumeMemory* memory) {
  const pipeline::Light& light = subject.scene.lights.at(0);
  if (method == Method::automatic) {
    const pipeline::Camera& camera = subject.camera;
    return pipeline::make_volumes(
        objects, light, {}, pipeline::near_region(camera.clip_from_world),
        {.counts = pipeline::Counts::at_receivers,
         .view = pipeline::View{camera.clip_from_world, camera.width, camera.height},
         .threads = threads,
         .memory = memory});
  }
  return pipeline::make_volumes(
      objects, light, {}, std::nullopt,
      {.method = method == Method::zpass ? VolumeMethod::zpass : VolumeMethod::zfail,
       .extrusion = {.kind = pipeline::Extrusion::Kind::infinite},
       .threads = threads,
       .memory = memory});
}

bool shows_one_side(const pipeline::PlacedObject& object) {
  return object.topology->faults.closed_manifold();
}

raster::MeshView counted(const pipeline::PlacedVolume& volume) {
  raster::MeshView view = volume.volume->view();
  if (volume.method == VolumeMethod::zpass) {
    view.indices =
        view.indices.subspan(volume.volume->front_cap_indices, volume.volume->side_indices);
  }
  return view;
}

void record_volumes(raster::Frame& frame, const Subject& subject,
                    std::span<const pipeline::PlacedObject> objects, Method method, int threads,
                    pipeline::VolumeMemory& memory) {
  const auto volumes = make_volumes(subject, objects, method, threads, &memory);
  if (method != Method::zpass) return pipeline::count_volumes(frame, volumes, {});
  for (const pipeline::PlacedVolume& volume : volumes) count_sides(frame, volume);
}

}  // namespace gnomon::bench
