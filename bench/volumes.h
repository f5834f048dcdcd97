// The volumes of a subject's light, for every system that counts them, and how gnomon records them.
#pragma once

#include <span>
#include <vector>

#include "bench/runner.h"
#include "bench/subject.h"
#include "pipeline/count_volumes.h"
#include "pipeline/placed_object.h"
#include "raster/frame.h"

namespace gnomon::bench {

/// zpass and zfail: to infinity, zpass without caps, whatever is best for a caster. auto: what the
/// pipeline takes. All where only the picture counts (pipeline::Counts::at_receivers): the volumes
/// have windows, which peers do not use. `memory` may be null.
std::vector<pipeline::PlacedVolume> make_volumes(const Subject& subject,
                                                 std::span<const pipeline::PlacedObject> objects,
                                                 Method method, int threads,
                                                 pipeline::VolumeMemory* memory);

/// Its back faces can be culled: a closed surface that the eye is outside of.
bool shows_one_side(const pipeline::PlacedObject& object);

/// Makes the volumes of this frame and records their counting draws. All that gnomon needs a frame
/// and peers are spared is in here.
void record_volumes(raster::Frame& frame, const Subject& subject,
                    std::span<const pipeline::PlacedObject> objects, Method method, int threads,
                    pipeline::VolumeMemory& memory);

}  // namespace gnomon::bench
