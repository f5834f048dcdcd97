// Stencil counts against rays: where do they disagree, and why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/count_volumes.h"
#include "pipeline/ray_reference.h"
#include "raster/buffers.h"
#include "raster/execute.h"

namespace gnomon::test {

/// Depth and stencil after the scene's surfaces and all its volumes of the first light.
struct Counted {
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;
  /// Volumes counted on depth pass and on depth fail.
  std::size_t zpass = 0, zfail = 0;
};
Counted count_scene(const pipeline::Scene& scene, const pipeline::Camera& camera,
                    const pipeline::VolumeOptions& options,
                    const pipeline::CountOptions& count_options = {});

enum class Reason { edge, depth_tie, none };

/// Why the rays may see light where `counted_shadow` says shadow at a pixel, or the other way.
/// `depth` is what a D24 buffer holds there.
Reason why(const pipeline::Scene& scene, const pipeline::RayReference& rays,
           const pipeline::Camera& camera, const glm::vec4& light, int x, int y,
           std::uint32_t depth, bool counted_shadow);

struct Disagreement {
  /// Pixels that show a surface; those of a surface in front of the near plane are left out.
  std::size_t tested = 0, before_near = 0;
  std::size_t wrong = 0;
  /// Wrong pixels with a place within one pixel where the rays say what the stencil says, or where
  /// the depth buffer holds another surface than the ray's: a silhouette or a shadow's edge passes.
  /// Also those whose ray passes an edge of the visible object no farther than corners snap.
  std::size_t at_edge = 0;
  /// Wrong pixels whose visible point changes between light and shadow when it moves by two units
  /// of the depth buffer (and float32's rounding of the corners), or that have another surface so
  /// little behind the visible one.
  std::size_t depth_tie = 0;
  std::size_t unexplained = 0;
  Disagreement& operator+=(const Disagreement& other);
};

/// Compares every pixel that shows a surface; the light is the scene's first.
Disagreement compare_with_rays(const Counted& counted, const pipeline::Scene& scene,
                               const pipeline::RayReference& rays, const pipeline::Camera& camera);

}  // namespace gnomon::test
