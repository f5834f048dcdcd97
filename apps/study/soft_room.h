// The example room: a photograph, the light that was captured there, and Gibson's method on it.
// Everything is read when it is first asked for; the light is found once.
// Invariant: the same pictures for every number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "ar/camera.h"
#include "ar/image.h"
#include "ar/pinhole_view.h"
#include "pipeline/differential_method.h"
#include "pipeline/light_paths.h"
#include "pipeline/lit_scene.h"
#include "pipeline/reduced_occluder.h"
#include "pipeline/scene.h"

namespace gnomon::apps::study {

/// Rows r, g, b, a from the bottom row; a is 255 where a virtual object is seen.
struct SoftPicture {
  std::vector<std::uint8_t> rows;
  /// Channels of the target that are not finite.
  std::size_t not_finite = 0;
  /// Shadows that were made.
  std::size_t shadows = 0;
};

class SoftRoom {
 public:
  /// A box in the air and a head on the floor, each at two places.
  static constexpr std::size_t kScenes = 4;

  /// `folder` is examples/soft.
  SoftRoom(std::filesystem::path folder, int threads);
  ~SoftRoom();

  /// Throws ar::InputError.
  const pipeline::LitScene& lit();
  /// Sources that paths of this share of the power have.
  std::size_t sources(double power_share);

  /// The scene's picture with these shadows, as the photograph's pinhole view shows it: drawn and
  /// finished with `tone` in the place of the light's own where it is given. Throws ar::InputError.
  SoftPicture draw(std::size_t scene, double power_share, const pipeline::ShadowTakeOptions& take,
                   const pipeline::ToneCurve* tone = nullptr);

  /// Numbers of pixels, from the bottom row, that show no virtual object and that the shadows of
  /// all sources of all power, in floats, change by 2 values or more.
  const std::vector<std::size_t>& shadow_region(std::size_t scene);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Pixels of the region that differ by more than `bound` in a channel.
double differing(const SoftPicture& a, const SoftPicture& b, const std::vector<std::size_t>& region,
                 int bound);

}  // namespace gnomon::apps::study
