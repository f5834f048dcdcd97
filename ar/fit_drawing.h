// Draws a scene with exchanged models and settings again and again, always in the same views:
// photographs whose poses were found once, or the scene's own camera.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "ar/fit_scene.h"
#include "ar/image.h"

namespace gnomon::ar {

/// A photograph and how messages call it.
struct NamedPicture {
  std::string name;
  Image picture;
};

struct FitPictures {
  /// One a view.
  std::vector<Image> pictures;
  /// Of all views together, from a photograph to what is shown, without finding tags.
  double ms = 0.0;
  /// Differential shadows' passes, of the view that has most.
  std::size_t passes = 0;
};

class FitDrawing {
 public:
  virtual ~FitDrawing() = default;

  /// In place of each photograph a uniform grey one, so that no pattern hides an error or looks
  /// like one.
  virtual FitPictures draw(const FitScene& scene) = 0;
  /// The same views without what the scene adds: the grey, or the scene without shadows.
  virtual std::vector<Image> untouched(const FitScene& scene) = 0;
  /// The first view as a person sees it, on the photograph itself.
  virtual Image show(const FitScene& scene) = 0;
  /// Names of the objects that are in any view.
  virtual const std::set<std::string>& placed() const = 0;
};

/// Finds the poses as `gnomon ar` does with a still. Throws InputError, also where no virtual
/// object can be placed. `lit_scene` as SessionOptions.
std::unique_ptr<FitDrawing> draw_in_photographs(const SceneFile& file,
                                                std::vector<NamedPicture> photographs,
                                                const std::filesystem::path& lit_scene,
                                                int threads);

/// As `gnomon render`. Throws InputError.
std::unique_ptr<FitDrawing> draw_by_itself(const SceneFile& file, int threads);

}  // namespace gnomon::ar
