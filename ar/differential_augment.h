// One photograph to one augmented photograph with soft shadows from the real scene's own light
// (Gibson 2003): the pinhole view, the differential method, and the way back through the lens.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include <glm/mat4x4.hpp>

#include "ar/augment.h"
#include "ar/camera.h"
#include "ar/image.h"
#include "ar/pinhole_view.h"
#include "pipeline/differential_method.h"
#include "pipeline/light_paths.h"
#include "pipeline/lit_scene.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

struct DifferentialSettings {
  pipeline::DifferentialOptions method;
  pipeline::LightPathOptions light;
  /// Milliseconds a frame may take from photograph to composite; 0: method.take.passes always.
  double budget_ms = 0.0;
  /// Triangles that an object casts with, at most, if it has no shadow model of its own; 0: all.
  std::size_t occluder_triangles = 500;
  /// As AugmentOptions; samples 0 is 1 here, since each pixel is looked up once a source.
  int samples = 0, threads = 0;
  double near_m = 0.02, far_m = 100.0;
  bool masks = true, steps = false, frame = false;
};

/// Of one picture: sources whose light may be hidden, patches it may be hidden from, shadows that
/// were made, and sources that none could be made for (pipeline::DifferentialShadows).
struct DifferentialReport {
  std::size_t occluded_sources = 0, receivers = 0, shadows = 0, left_out = 0;
  /// Of record_ms, what finding those sources and patches took.
  double traverse_ms = 0.0;
};

class DifferentialAugmenter {
 public:
  /// Receivers are the patches that are seen from `still_camera` (OpenCV's axes), or all of them
  /// where the camera moves. Computes the light's paths, which takes a second or so.
  /// Errors: as PinholeView.
  DifferentialAugmenter(const Lens& lens, std::shared_ptr<const pipeline::LitScene> scene,
                        const std::optional<glm::dmat4>& still_camera,
                        const DifferentialSettings& settings);
  ~DifferentialAugmenter();
  DifferentialAugmenter(DifferentialAugmenter&&) noexcept;

  const PinholeView& view() const;
  const pipeline::LightPaths& paths() const;
  /// From the next picture on, in place of the settings' number; not with a budget.
  void set_passes(std::size_t passes);
  /// As DifferentialSettings::steps, from the next picture on.
  void keep_steps(bool keep);

  /// Only virtual objects of `objects` are drawn and cast; the real ones are the lit scene's.
  /// Preconditions: three channels, the camera's size; a pose that can be inverted.
  Augmented augment(const Image& photograph, const pipeline::Scene& objects,
                    const glm::dmat4& world_from_camera);
  /// Of the last picture.
  const DifferentialReport& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The scene with its virtual objects alone.
pipeline::Scene virtual_ones(pipeline::Scene scene);

/// Patches that a grid of rays through the view meets from their front, every few pixels, and the
/// neighbours that share a vertex with them; ascending.
std::vector<std::uint32_t> visible_patches(const pipeline::LitScene& scene,
                                           const pipeline::Camera& camera);

}  // namespace gnomon::ar
