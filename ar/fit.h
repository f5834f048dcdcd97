// The least that a scene needs, found by measurement on its own pictures: models with fewer
// triangles, phantoms left out, fewer passes, sources and drawn pixels, as far as the picture stays
// within a bound of the exact one (docs/fit.md).
// Invariant: what comes out was drawn as a whole, with everything that was reduced, and its error
// is at most the bound, in every photograph.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ar/fit_drawing.h"
#include "ar/fit_items.h"
#include "ar/fit_scene.h"
#include "ar/image.h"
#include "ar/picture_error.h"
#include "ar/scene_file.h"

namespace gnomon::ar {

struct FitOptions {
  ErrorBound bound;
  /// Frames that a time is the median of, after one that is not counted, in turns with the scene
  /// that it is compared with.
  int repeat = 5;
  /// 0: as many as the machine has.
  int threads = 0;
  /// As SessionOptions.
  std::filesystem::path lit_scene;
  /// Told how many items were looked at, and of how many.
  std::function<void(std::size_t done, std::size_t all)> progress;
};

/// One thing that was looked at.
struct FitFinding {
  std::string item, unit;
  std::string given, taken;
  double given_amount = 0.0, taken_amount = 0.0;
  /// Milliseconds that a frame of the given scene takes less with the item's least option.
  double saves_ms = 0.0;
  /// The next option that would have been less, and the whole picture's error with it; absent where
  /// none was left.
  std::optional<std::string> next;
  double next_error = 0.0;
  /// "kept", "reduced", "dropped", "raised" (the given option was outside the bound) or, of a
  /// phantom's shadow, "gone with the phantom".
  std::string outcome;
};

/// A scene as it was drawn.
struct FitState {
  /// The largest of all views against the exact scene.
  double error = 0.0;
  /// Of a frame, all views together: the given scene's median; the fitted one's is that less the
  /// median of what frames drawn in turns differ by.
  double ms = 0.0;
  std::size_t passes = 0;
  FitTotals totals;
};

struct FitResult {
  FitScene given, fitted;
  FitState before, after;
  std::vector<FitFinding> findings;
  /// Objects in no picture, which stay as they are; what the readers left out.
  std::vector<std::string> left_out, notes;
  /// Frames that were drawn to find it.
  std::size_t drawn = 0;
};

class Fitter {
 public:
  /// Without photographs the scene is drawn by itself. Throws InputError, also for a scene that
  /// needs a photograph and got none.
  Fitter(const SceneFile& file, std::vector<NamedPicture> photographs, const FitOptions& options);
  ~Fitter();

  /// Throws InputError if the result is outside the bound, which no result may be.
  FitResult search();

  /// Of a scene with the same objects, lights and views, perhaps read from a file.
  double error_of(const FitScene& scene);
  /// The first view as a person sees it.
  Image show(const FitScene& scene);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gnomon::ar
