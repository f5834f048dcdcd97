#include "apps/inspector/turn.h"

#include <cmath>

namespace gnomon::apps::inspector {

Turn turn_of_degrees(double degrees) {
  constexpr double kRadiansPerDegree = 0.017453292519943295;
  const double quarters = std::nearbyint(degrees / 90.0);
  const double x = (degrees - 90.0 * quarters) * kRadiansPerDegree, square = x * x;
  // Taylor's series; for |x| <= pi / 4 the first term that is left out is below 1e-17.
  double cosine = 0.0, sine = 0.0;
  for (int n = 18; n > 0; n -= 2) {
    cosine = (1.0 - square / (n * (n - 1)) * (n == 18 ? 1.0 : cosine));
    sine = (1.0 - square / (n * (n + 1)) * (n == 18 ? 1.0 : sine));
  }
  sine *= x;
  const int quarter = static_cast<int>(std::fmod(std::fmod(quarters, 4.0) + 4.0, 4.0));
  switch (quarter) {
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    case 3:
      return {sine, -cosine};
    default:
      return {cosine, sine};
  }
}

}  // namespace gnomon::apps::inspector
