// Blending and colour mask (OpenGL 4.6, sections 17.3.6 and 17.4). RGBA8: the source is rounded to
// 8 bits first, factors are 8-bit integers, and the result is the exact rational rounded to nearest
// (ties cannot occur: the denominator is 255). RGBA32F: float32, each operation rounded once;
// nothing is clamped; a NaN is stored as 0x7fc00000, and a stored NaN that a NaN is written over
// stays.
#pragma once

#include <array>

#include <glm/vec4.hpp>

#include "raster/buffers.h"
#include "raster/state.h"

namespace gnomon::raster {

/// The stored value after source is written over it; `constant` is the blend's constant colour.
Rgba8 blend_rgba8(const ColorState& state, const Rgba8& constant, const Rgba8& source,
                  const Rgba8& stored) noexcept;
glm::vec4 blend_rgba32f(const ColorState& state, const glm::vec4& source,
                        const glm::vec4& stored) noexcept;

}  // namespace gnomon::raster
