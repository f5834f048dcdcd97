#include "bench/statistics.h"

#include <algorithm>
#include <cmath>

#include "raster/check.h"

namespace gnomon::bench {

double median(std::vector<double> values) {
  raster::require(!values.empty(), "a median is one of at least one value");
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double log_log_slope(std::span<const double> x, std::span<const double> y) {
  raster::require(x.size() == y.size() && x.size() >= 2, "a slope is one of at least two points");
  const double count = static_cast<double>(x.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    raster::require(x[i] > 0.0 && y[i] > 0.0, "a logarithm is one of a positive number");
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  double along = 0.0, across = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    along += dx * dx;
    across += dx * (std::log(y[i]) - mean_y);
  }
  raster::require(along > 0.0, "a slope is one of different x");
  return across / along;
}

}  // namespace gnomon::bench
