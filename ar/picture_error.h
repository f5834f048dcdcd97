// How far a picture may be from another one, as a person says it, and how far it is: in pixels
// (ar/displacement.h) or in FLIP (ar/flip.h).
#pragma once

#include <string>
#include <string_view>

#include "ar/image.h"

namespace gnomon::ar {

enum class ErrorUnit { pixels, flip };

struct ErrorBound {
  ErrorUnit unit = ErrorUnit::pixels;
  double value = 1.0;
};

/// "1px", more than 0 and up to 16, or "0.02flip", more than 0 and up to 1. Throws InputError.
ErrorBound parse_error_bound(std::string_view text);

/// pixels: the displacement; flip: the mean error over the pixels where either picture is not
/// `untouched`, which is what both are without the shadows and objects that are compared; 0 where
/// there is no such pixel. Preconditions: three channels, one size.
double picture_error(ErrorUnit unit, const Image& reference, const Image& test,
                     const Image& untouched);

/// "0.71 px", "more than 16 px" or "0.0123 FLIP".
std::string describe_error(ErrorUnit unit, double error);

}  // namespace gnomon::ar
