// What the differential method approximates, by rays (Debevec 1998): for each pixel the light of
// all patches that virtual objects hide from the visible point, less what the objects send from
// there, subtracted from the photograph's radiance in floats, then mapped to values. Uses the same
// lit scene, and nothing of sources, shafts, maps or vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/lit_scene.h"
#include "pipeline/ray_reference.h"
#include "pipeline/scene.h"
#include "raster/image_view.h"

namespace gnomon::pipeline {

struct ReferenceOptions {
  /// Points of a patch that are asked for, at receivers and on virtual objects: 1, 4 or 16.
  int samples = 16, object_samples = 4;
  /// Where an object hides a patch, the light that its own surface sends the same way is given
  /// back; without it the room sees black objects.
  bool returned_light = true;
  /// As ShadowTakeOptions.
  bool by_share = true;
  int threads = 0;
};

struct ReferencePicture {
  /// Three bytes a ray, in the rays' order.
  std::vector<std::uint8_t> pixels;
  /// One a ray: is a virtual object visible? Does one take light away there?
  std::vector<std::uint8_t> object, shadow;
};

/// Refers to the lit scene; copies the virtual scene.
class DifferentialReference {
 public:
  /// Errors: std::runtime_error when Embree cannot start.
  DifferentialReference(const LitScene& scene, const Scene& virtual_scene);
  ~DifferentialReference();

  /// One ray a pixel, with the photograph's three bytes of it. A ray that meets nothing keeps its
  /// pixel.
  ReferencePicture render(std::span<const Ray> rays, std::span<const std::uint8_t> photograph,
                          const ReferenceOptions& options) const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace gnomon::pipeline
