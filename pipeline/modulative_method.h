// Modulative shadows (Kuehl, section 4.2): the scene wholly lit, then for each light its counts in
// the stencil buffer and a dark quad over the whole view where they are not 0. Quicker than adding
// light by light and wrong in principle: what a shadow takes away is a part of everything, so
// highlights stay where no light is and ambient light is lost where it should stay.
#pragma once

#include <glm/vec4.hpp>

#include "pipeline/count_volumes.h"
#include "pipeline/scene.h"
#include "pipeline/topology.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

struct ModulativeOptions {
  VolumeMethod method = VolumeMethod::automatic;
  Extrusion extrusion;
  /// The quad's colour, blended by its alpha.
  glm::vec4 shadow_color{0.0f, 0.0f, 0.0f, 0.5f};
  glm::vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
  /// Topologies kept between frames; null builds them anew.
  TopologyCache* topologies = nullptr;
  /// Memory of volumes kept between frames; null allocates it anew.
  VolumeMemory* volumes = nullptr;
  /// Threads that make volumes, as in raster::ExecuteOptions.
  int threads = 0;
};

/// Records the frame; every object is drawn. Every shadow is found by
/// volumes, whatever method but `none` the light names. Labels: "lit scene", then "shadow volumes:
/// LIGHT" and "shadow quad: LIGHT". The quad replaces the stencil by 0 whether a fragment passes or
/// fails, as the paper's does: each pixel darkens once a light, and the stencil is 0 again. Pixels
/// without a surface keep their colour, which the paper's quad would darken. A spot's shadow is
/// darkened outside its beam too. Preconditions: all three targets; `scene` outlives the execution
/// of the frame.
raster::Frame record_modulative(const Scene& scene, const Camera& camera,
                                const raster::Targets& targets,
                                const ModulativeOptions& options = {});

}  // namespace gnomon::pipeline
