// How far one picture is from another in pixels: not how much values differ, but how far away the
// right value lies. A shadow whose edge is a pixel off has an error of one pixel however dark it
// is, and a shadow that is missing has one without bound.
// Both pictures are taken as continuous along their rows and columns: between two neighbouring
// pixels' centres lie the values of the straight line between theirs, so that an edge that is
// smoothed in one picture and hard in the other is found within the pixel where it is.
#pragma once

#include <cstddef>
#include <limits>

#include "ar/image.h"

namespace gnomon::ar {

struct DisplacementOptions {
  /// Values of 255 by which each channel may differ. 3: two roundings to 8 bits, of the value and
  /// of a mean over drawn pixels, leave 1; the shading of one more vertex or pass another 1 or 2,
  /// and at a grey of 192 a step of 3 is below what is seen (1.6 %).
  int tolerance = 3;
  /// How far a value is looked for, in pixels, 1 to 64.
  int radius = 16;
  /// Groups of so many failing pixels, neighbours by side or corner, are passed over: depths that
  /// tie, and stray pixels. By corner too, so that a thin slanted line is one group.
  std::size_t speck = 4;
};

struct Displacement {
  /// Infinite: a value is nowhere within the radius.
  double px = 0.0;
  /// Pixels that differ by more than the tolerance, and those of them that were passed over.
  std::size_t differing = 0, passed_over = 0;
  bool is_beyond() const { return px == std::numeric_limits<double>::infinity(); }
};

/// A pixel's error is the distance from its centre to the nearest place where the other picture has
/// its value within the tolerance; 0 where both differ by no more at the pixel itself. It is taken
/// in both directions, and the larger counts, so that what is missing in one picture is found in
/// the other. The result is the least distance beyond which only specks fail.
/// Preconditions: the same size and number of channels.
Displacement displacement(const Image& reference, const Image& test,
                          const DisplacementOptions& options = {});

}  // namespace gnomon::ar
