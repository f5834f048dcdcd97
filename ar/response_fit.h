// The camera's response from bracketed exposures (Debevec and Malik 1997): the curve, and the
// radiance of every pixel, that explain best what each exposure time made of it. Every pixel takes
// part: what a pixel's own radiance adds to the least squares is eliminated before they are solved
// (a Schur complement), so that their size is that of the curve whatever the number of pixels.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ar/brackets.h"

namespace gnomon::ar {

/// Light that a pixel gathered (radiance times seconds) for each of its values; strictly increasing
/// from 0 at value 0, in a unit of its own for each channel: value 255 is 1.
struct ExposureCurve {
  std::array<std::array<double, 256>, 3> exposure_from_value{};

  bool operator==(const ExposureCurve&) const = default;
};

struct ResponseFitOptions {
  /// Weight of the curve's second differences over that of all pixels. 10 to 100 are best on
  /// rendered brackets; a tenth or ten times as much doubles the error (docs/capture.md).
  double smoothness = 100.0;
  int threads = 0;
};

/// From several bracket sets of one camera together. Deterministic: sums are of fixed pieces of the
/// pictures, in order. Throws InputError naming the list: a channel whose values between black and
/// saturation no two exposures share, so that nothing ties the curve together, or an exposure
/// whose time disagrees with the others' by more than half as much again.
ExposureCurve fit_response(std::span<const Brackets> sets, const ResponseFitOptions& options = {});

/// How much longer than its stated time an exposure looks under the curve: the median over its
/// pixels that other exposures of the set see well too; 1 where there are none.
std::vector<double> time_ratios(const Brackets& brackets, const ExposureCurve& curve);

}  // namespace gnomon::ar
