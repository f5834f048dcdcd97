// Bracketed exposures: one view taken with several exposure times, from which its radiance is found
// (Debevec and Malik 1997).
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "ar/image.h"

namespace gnomon::ar {

struct Exposure {
  std::filesystem::path file;
  double time_s = 0.0;
  /// Three channels.
  Image picture;
};

struct Brackets {
  /// The list that names the pictures.
  std::filesystem::path list;
  /// Shortest time first; two at least, all of one size.
  std::vector<Exposure> exposures;
  /// What the list calls auto_exposure_time_s: the time of the photograph that belongs to it.
  std::optional<double> photograph_time_s;

  int width() const { return exposures.front().picture.width; }
  int height() const { return exposures.front().picture.height; }
};

/// Reads {"exposures": [{"file": NAME, "time_s": SECONDS}, ...], "auto_exposure_time_s": SECONDS};
/// names are relative to the list, other keys are left alone. Throws InputError: fewer than two or
/// more than 64 exposures, a time that is not a positive number of seconds below 1e6, equal times
/// throughout, a picture that cannot be read or has another size than the first, pictures that are
/// all black or all saturated, or one that is darker than one of a shorter time.
Brackets read_brackets(const std::filesystem::path& list);

}  // namespace gnomon::ar
