// A light's shadows in the general method's picture against rays.
#pragma once

#include <cstddef>

#include "pipeline/general_method.h"
#include "pipeline/scene.h"
#include "raster/buffers.h"
#include "raster/execute.h"

namespace gnomon::test {

struct LightBuffers {
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;
  LightBuffers(int width, int height)
      : color(width, height, raster::ColorFormat::rgba32f),
        depth(width, height),
        stencil(width, height) {}
};

/// What is kept between frames.
struct LightMemory {
  pipeline::TopologyCache topologies;
  pipeline::VolumeMemory volumes;
  pipeline::MapMemory maps;
  pipeline::AliasFreeMemory alias_free;
  raster::ExecuteMemory executing;
};

/// Draws the scene with its first light's shadows found so; milliseconds of recording and executing
/// on one thread.
double draw_light(LightBuffers& buffers, LightMemory& memory, pipeline::Scene scene,
                  const pipeline::Camera& camera, pipeline::ShadowMethod method,
                  const pipeline::MapSettings& settings = {});

struct LightCheck {
  /// Pixels that the light reaches or would reach; of them those that are dark and that Embree sees
  /// lit, and the other way; of both, those that no edge and no depth tie explains
  /// (tests/pipeline/stencil_check.h).
  std::size_t tested = 0, dark = 0, light = 0, unexplained = 0;
  LightCheck& operator+=(const LightCheck& other);
};

/// Left out are pixels to which the light adds nothing, shadow or not: a round body's normals may
/// be turned from it where its triangles are not.
LightCheck check_light(LightMemory& memory, const pipeline::Scene& scene,
                       const pipeline::Camera& camera, pipeline::ShadowMethod method,
                       const pipeline::MapSettings& settings = {});

}  // namespace gnomon::test
