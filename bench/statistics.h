// What many measurements come down to.
#pragma once

#include <span>
#include <vector>

namespace gnomon::bench {

/// The middle value; of an even number the mean of the two in the middle.
/// Precondition: there is one.
double median(std::vector<double> values);

/// The slope of the least-squares line through (log x, log y): the exponent with which y grows.
/// Preconditions: as many x as y, at least two different x, all positive.
double log_log_slope(std::span<const double> x, std::span<const double> y);

}  // namespace gnomon::bench
