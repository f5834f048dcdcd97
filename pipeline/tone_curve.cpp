#include "pipeline/tone_curve.h"

#include <algorithm>
#include <cmath>

#include "raster/check.h"

namespace gnomon::pipeline {

double ToneCurve::value(std::size_t channel, double radiance) const {
  const std::array<float, 256>& table = radiance_from_value[channel];
  if (!(radiance > static_cast<double>(table.front()))) return 0.0;
  if (radiance >= static_cast<double>(table.back())) return 255.0;
  // The first value that is brighter; not the first of all.
  const auto above =
      std::upper_bound(table.begin(), table.end(), radiance,
                       [](double at, float entry) { return at < static_cast<double>(entry); });
  const double low = above[-1], high = above[0];
  return static_cast<double>(above - table.begin() - 1) + (radiance - low) / (high - low);
}

double ToneCurve::value_from(std::size_t channel, double radiance, std::size_t& near) const {
  const std::array<float, 256>& table = radiance_from_value[channel];
  if (!(radiance > static_cast<double>(table.front()))) {
    near = 0;
    return 0.0;
  }
  if (radiance >= static_cast<double>(table.back())) {
    near = 254;
    return 255.0;
  }
  while (static_cast<double>(table[near]) > radiance) --near;
  while (static_cast<double>(table[near + 1]) <= radiance) ++near;
  const double low = table[near], high = table[near + 1];
  return static_cast<double>(near) + (radiance - low) / (high - low);
}

glm::dvec3 ToneCurve::value(const glm::dvec3& radiance) const {
  return {value(0, radiance.x), value(1, radiance.y), value(2, radiance.z)};
}

double ToneCurve::radiance(std::size_t channel, double value) const {
  const std::array<float, 256>& table = radiance_from_value[channel];
  const double at = std::clamp(value, 0.0, 255.0);
  const auto whole = std::min(static_cast<std::size_t>(at), std::size_t{254});
  const double low = table[whole], high = table[whole + 1];
  return low + (high - low) * (at - static_cast<double>(whole));
}

ToneCurve ToneCurve::from_gamma(double gamma, double white) {
  raster::require(gamma >= 0.1 && gamma <= 10.0, "a gamma is between 0.1 and 10");
  raster::require(white > 0.0 && std::isfinite(white), "white is a positive radiance");
  ToneCurve curve;
  for (std::size_t v = 0; v < 256; ++v) {
    const auto radiance =
        static_cast<float>(white * std::pow(static_cast<double>(v) / 255.0, gamma));
    for (auto& table : curve.radiance_from_value) table[v] = radiance;
  }
  return curve;
}

}  // namespace gnomon::pipeline
