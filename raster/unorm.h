// Conversion between floats and unsigned normalized integers (OpenGL 4.6, section 2.3.5): clamp,
// then round to nearest, ties to even.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/vec4.hpp>

#include "raster/buffers.h"

namespace gnomon::raster {

/// The integer nearest to a finite value of small magnitude, ties to even.
inline std::int64_t round_to_nearest(double value) { return std::llrint(value); }

/// NaN converts to 0.
inline std::uint8_t float_to_unorm8(float value) {
  if (!(value > 0.0f)) return 0;
  if (value >= 1.0f) return 255;
  return static_cast<std::uint8_t>(std::lrint(value * 255.0f));
}

inline float unorm8_to_float(std::uint8_t value) { return static_cast<float>(value) / 255.0f; }

inline Rgba8 to_rgba8(const glm::vec4& c) {
  return {float_to_unorm8(c.r), float_to_unorm8(c.g), float_to_unorm8(c.b), float_to_unorm8(c.a)};
}

inline glm::vec4 to_floats(const Rgba8& c) {
  return {unorm8_to_float(c[0]), unorm8_to_float(c[1]), unorm8_to_float(c[2]),
          unorm8_to_float(c[3])};
}

/// The integer that stands for depth 1.0.
inline std::uint32_t max_depth(DepthFormat format) {
  return format == DepthFormat::d24 ? 0xffffffu : 0xffffu;
}

inline std::uint32_t float_to_depth(float value, DepthFormat format) {
  const std::uint32_t one = max_depth(format);
  if (!(value > 0.0f)) return 0;
  if (value >= 1.0f) return one;
  return static_cast<std::uint32_t>(round_to_nearest(static_cast<double>(value) * one));
}

}  // namespace gnomon::raster
