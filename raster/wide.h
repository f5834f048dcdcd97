// Integers wider than 64 bits and exactly rounded quotients.
#pragma once

#include <cmath>
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

/// numerator / denominator to the nearest integer, a half upwards, modulo 2^64, from an estimate of
/// the quotient and the numerator's low 64 bits. The result does not depend on the estimate: the
/// remainder is exact.
/// Preconditions: 0 < denominator < 2^52; |estimate| < kLargestEstimate; estimate and quotient are
/// apart by less than 2^10 + 2^60 / denominator.
inline constexpr double kLargestEstimate = 0x1p59;
inline std::uint64_t round_div_near(std::uint64_t numerator, std::int64_t denominator,
                                    double estimate) {
  const std::int64_t quotient = std::llrint(estimate);
  // Below 2^63, so its low 64 bits are all of it.
  const auto remainder = static_cast<std::int64_t>(
      numerator - static_cast<std::uint64_t>(quotient) * static_cast<std::uint64_t>(denominator));
  if (remainder >= -(denominator >> 1) && remainder < (denominator + 1) >> 1)
    return static_cast<std::uint64_t>(quotient);
  return static_cast<std::uint64_t>(quotient) +
         static_cast<std::uint64_t>(round_div(remainder, denominator));
}

}  // namespace gnomon::raster
