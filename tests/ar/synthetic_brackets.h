// Bracketed exposures of a known scene through a known response, in memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "ar/brackets.h"

namespace gnomon::ar {

/// A camera whose value is round(255 * f(exposure)).
using ResponseFunction = std::function<double(double exposure)>;

inline double gamma_response(double exposure) {
  return std::pow(std::clamp(exposure, 0.0, 1.0), 1.0 / 2.2);
}

/// A concave curve with a shoulder, as cameras have.
inline double shoulder_response(double exposure) {
  const double x = std::pow(std::clamp(exposure, 0.0, 1.0), 0.56);
  return 1.42 * x / (1.0 + 0.42 * x);
}

/// Radiance over four decades, a different one in each channel of each pixel.
inline double ramp_radiance(int i, int count, int channel) {
  return std::pow(10.0, -2.0 + 4.0 * ((i * 7 + channel * 3) % count) / count);
}

inline Brackets synthetic_brackets(int width, int height, const std::vector<double>& times_s,
                                   const std::function<double(int pixel, int channel)>& radiance,
                                   const ResponseFunction& response, double noise = 0.0) {
  Brackets set;
  set.list = "synthetic.json";
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (const double time_s : times_s) {
    Exposure exposure{"synthetic.png", time_s, {width, height, 3, {}}};
    for (int i = 0; i < width * height; ++i)
      for (int c = 0; c < 3; ++c) {
        double light = radiance(i, c) * time_s;
        if (noise > 0.0) light += noise * std::sqrt(std::max(light, 0.0)) * normal(random);
        exposure.picture.pixels.push_back(
            static_cast<std::uint8_t>(std::lround(255.0 * response(light))));
      }
    set.exposures.push_back(std::move(exposure));
  }
  return set;
}

inline std::vector<double> stops(int count, double shortest_s, double factor) {
  std::vector<double> times;
  for (int k = 0; k < count; ++k) times.push_back(shortest_s * std::pow(factor, k));
  return times;
}

}  // namespace gnomon::ar
