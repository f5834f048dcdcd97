// A short series of noisy pictures of tags from a camera that stands still: what the tracker makes
// of it with its filter and without, and what becomes of the shadows.
// Invariant: the same for the same input.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "apps/study/desk_scene.h"
#include "apps/study/sweep.h"
#include "ar/image.h"

namespace gnomon::apps::study {

/// Pictures a series, and between them the time of the desk's video (12 a second).
inline constexpr std::size_t kSeriesPictures = 6;

struct TagInput {
  /// With what is true of the picture: `poses`, and the size of `photograph`.
  DeskScene* scene = nullptr;
  /// Of the scene's camera, perhaps smaller. Without noise.
  ar::Image picture;
  double noise = 0.0;
  std::uint32_t seed = 0;
};

struct TagSeries {
  /// Pictures without a pose of the camera: given (held for a while) and measured; and bodies
  /// without a measured one.
  Outcome unplaced, unmeasured, bodies_unmeasured;
  /// With the filter and without it.
  static constexpr std::size_t kFilters = 2;
  /// Pixels of both shadow masks that change from one picture to the next, and those that differ
  /// from the masks of the true poses. A picture without a pose of the camera is wholly wrong.
  std::array<Outcome, kFilters> flicker, misplaced;
};

TagSeries run_series(Desk& desk, const TagInput& input);

}  // namespace gnomon::apps::study
