// Bracketed exposures merged to linear radiance.
#pragma once

#include <cstddef>

#include "ar/brackets.h"
#include "ar/image_file.h"
#include "ar/response_fit.h"

namespace gnomon::ar {

struct MergedRadiance {
  /// In the curve's unit a second, a channel at a time.
  FloatImage picture;
  /// Pixels with a channel that every exposure saturates: at least as bright as given.
  std::size_t saturated = 0;
  /// Pixels black in every exposure.
  std::size_t black = 0;
};

/// Each exposure says exposure / time; they are averaged with the inverse of their variance, taking
/// a pixel's value to be uncertain by the same amount everywhere: (time * slope of the response)^2.
/// Values of 0 and of 253 and more have no part where another exposure does better.
MergedRadiance merge_radiance(const Brackets& brackets, const ExposureCurve& curve,
                              int threads = 0);

}  // namespace gnomon::ar
