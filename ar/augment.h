// One photograph to one augmented photograph: the pinhole view, the method's frame, its execution,
// and the way back through the lens.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "ar/camera.h"
#include "ar/image.h"
#include "ar/pass_pictures.h"
#include "ar/pinhole_view.h"
#include "pipeline/haller.h"
#include "pipeline/scene.h"

namespace gnomon::ar {

struct AugmentOptions {
  pipeline::VolumeMethod method = pipeline::VolumeMethod::automatic;
  pipeline::Extrusion extrusion;
  bool double_shadows = false;
  /// View pixels a photograph's pixel along x and y; 0: what the lens needs (PinholeView).
  int samples = 0;
  /// 0: as many as the machine has.
  int threads = 0;
  /// Distances along the camera's axis that depth resolves; nothing is cut off there.
  double near_m = 0.02, far_m = 100.0;
  /// Also make the masks and the picture of counts.
  bool masks = true;
  /// Also keep the buffers after every pass.
  bool steps = false;
  /// Also keep the recorded frame's bytes.
  bool frame = false;
};

struct Augmented {
  Image composite;
  /// One channel, 255 or 0: a virtual shadow darkens a real surface; a real object's shadow falls
  /// on a virtual object; a virtual object is visible. Empty unless asked for.
  Image shadow_mask, shadow_on_virtual, object_mask;
  /// The counts of all volumes (step 3, first light) in false colour with a legend. Empty unless
  /// asked for.
  Image stencil_counts;
  /// In the photograph's geometry.
  std::vector<PassPictures> steps;
  std::vector<PassNote> passes;
  /// As encode_frame writes it (docs/frame-format.md). Empty unless asked for.
  std::vector<std::uint8_t> frame;
  double resample_ms = 0.0, record_ms = 0.0, execute_ms = 0.0, composite_ms = 0.0;
};

/// Keeps the view and its buffers from picture to picture.
class Augmenter {
 public:
  /// Errors: as PinholeView.
  Augmenter(const Lens& lens, const AugmentOptions& options);
  ~Augmenter();
  Augmenter(Augmenter&&) noexcept;

  const PinholeView& view() const;

  /// As AugmentOptions::steps, from the next picture on.
  void keep_steps(bool keep);

  /// One light is drawn in RGBA8 as in the paper; several, and a light of several points, in
  /// RGBA32F, since each part would be rounded. `world_from_camera` has OpenCV's axes.
  /// Preconditions: three channels, the camera's size; a pose that can be inverted.
  Augmented augment(const Image& photograph, const pipeline::Scene& scene,
                    const glm::dmat4& world_from_camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::ar
