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

/// round_div(numerator, denominator) modulo 2^64, faster, from an estimate of the quotient.
/// Preconditions: 0 < denominator < 2^52; the estimate is within 2^-50 of the quotient, relatively.
/// The result does not depend on the estimate: the remainder is exact.
inline std::uint64_t round_div_near(Int128 numerator, std::int64_t denominator, double estimate) {
  // Then estimate and quotient are apart by less than 2^10, so the remainder is below 2^63 and its
  // low 64 bits are all of it.
  constexpr double kLargest = 0x1p59;
  if (!(std::abs(estimate) < kLargest))
    return static_cast<std::uint64_t>(round_div(numerator, denominator));
  const std::int64_t quotient = std::llrint(estimate);
  const auto remainder = static_cast<std::int64_t>(static_cast<std::uint64_t>(numerator) -
                                                   static_cast<std::uint64_t>(quotient) *
                                                       static_cast<std::uint64_t>(denominator));
  const std::int64_t half = (denominator + 1) >> 1;
  if (remainder >= -(denominator >> 1) && remainder < half)
    return static_cast<std::uint64_t>(quotient);
  return static_cast<std::uint64_t>(quotient) +
         static_cast<std::uint64_t>(round_div(remainder, denominator));
}

}  // namespace gnomon::raster
