// Integers wider than 64 bits and exactly rounded quotients.
#pragma once

#include <cstdint>

namespace gnomon::raster {

__extension__ typedef __int128 Int128;

/// floor(numerator / denominator); denominator > 0.
inline Int128 floor_div(Int128 numerator, Int128 denominator) {
  const Int128 quotient = numerator / denominator;
  return numerator % denominator < 0 ? quotient - 1 : quotient;
}

/// numerator / denominator to the nearest integer, a half upwards; denominator > 0.
inline Int128 round_div(Int128 numerator, Int128 denominator) {
  return floor_div(2 * numerator + denominator, 2 * denominator);
}

}  // namespace gnomon::raster
