// A light's shadow in one view, drawn in any way and held against rays (pipeline/ray_reference.h).
// What is compared is the part of the light that is missing at a pixel, 0 to 1: a hard shadow has 0
// and 1 alone, a filtered one what lies between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "apps/study/shadow_setting.h"
#include "ar/image.h"
#include "pipeline/scene.h"

namespace gnomon::apps::study {

/// A scene with one light, and where it is seen from.
struct View {
  std::string name;
  pipeline::Scene scene;
  pipeline::Camera camera;
};

struct ShadowShot {
  /// The sum over the pixels tested of how far the missing part of the light is from what rays say
  /// (for a hard shadow the number of wrong pixels), and those pixels.
  double wrong = 0.0;
  std::size_t tested = 0;
  /// Of the wrong ones, in the same unit: what is too dark.
  double too_dark = 0.0;
  /// Channels of the colour buffer that are not finite.
  std::size_t not_finite = 0;

  double wrong_share() const { return tested ? wrong / static_cast<double>(tested) : 0.0; }
};

class ShadowTrial {
 public:
  /// Draws the light without shadows and asks rays. Threads as in raster::ExecuteOptions.
  /// Precondition: the scene has one light, of one sample.
  ShadowTrial(View view, int threads);
  ~ShadowTrial();
  ShadowTrial(ShadowTrial&&) noexcept;

  const View& view() const;
  /// Pixels that show a surface which faces the light and that it would light.
  std::size_t tested() const;
  /// Of those, the ones that rays see in shadow.
  std::size_t in_shadow() const;

  /// Draws the shadow and compares. Errors: as pipeline::record_general.
  ShadowShot measure(const ShadowSetting& setting);
  /// The rays' own shadow, of which nothing is wrong.
  ShadowShot measure_rays();

  /// Milliseconds of recording and executing the frame once, in RGBA8.
  double frame_ms(const ShadowSetting& setting);
  /// What rays take: building their tree, and one primary and one shadow ray a pixel.
  double rays_ms() const;

  /// Of what was measured last: the picture; and red where it is too dark, blue where too light,
  /// over a faint picture.
  ar::Image picture() const;
  ar::Image difference() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::apps::study
