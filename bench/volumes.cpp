#include "bench/volumes.h"

#include <memory>
#include <optional>

#include "pipeline/near_clip.h"
#include "pipeline/receivers.h"

namespace gnomon::bench {
namespace {

using pipeline::VolumeMethod;

}  // namespace

std::vector<pipeline::PlacedVolume> make_volumes(const Subject& subject,
                                                 std::span<const pipeline::PlacedObject> objects,
                                                 Method method, int threads,
                                                 pipeline::VolumeMemory* memory) {
  const pipeline::Camera& camera = subject.camera;
  pipeline::VolumeOptions options{
      .counts = pipeline::Counts::at_receivers,
      .view = pipeline::View{camera.clip_from_world, camera.width, camera.height},
      .threads = threads,
      .memory = memory};
  if (method != Method::automatic) {
    options.method = method == Method::zpass ? VolumeMethod::zpass : VolumeMethod::zfail;
    options.extrusion.kind = pipeline::Extrusion::Kind::infinite;
  }
  return pipeline::make_volumes(objects, subject.scene.lights.at(0), {},
                                pipeline::near_region(camera.clip_from_world), options);
}

bool shows_one_side(const pipeline::PlacedObject& object) {
  return object.topology->faults.closed_manifold();
}

void record_volumes(raster::Frame& frame, const Subject& subject,
                    std::span<const pipeline::PlacedObject> objects, Method method, int threads,
                    pipeline::VolumeMemory& memory) {
  pipeline::count_volumes(frame, make_volumes(subject, objects, method, threads, &memory), {});
}

}  // namespace gnomon::bench
