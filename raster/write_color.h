// Colours on their way to the pixels of a block: rounded, blended, masked.
#pragma once

#include <array>
#include <cstddef>

#include <glm/vec4.hpp>

#include "raster/blend.h"
#include "raster/buffers.h"
#include "raster/kernels.h"
#include "raster/tile_blocks.h"
#include "raster/unorm.h"

namespace gnomon::raster {

/// Colours for the pixels of a block on their way to an RGBA8 target.
using Rgba8Block = std::array<Rgba8, kPixelsPerBlock>;

/// Blends the mask's pixels of `source` into an RGBA8 target's block.
void write_rgba8(const Kernels& kernels, ColorBuffer& target, TileIndex tile, std::size_t offset,
                 const ColorState& state, PixelMask mask, const Rgba8Block& source);

/// One colour for all pixels of the mask.
void write_constant(const Kernels& kernels, ColorBuffer& target, TileIndex tile, std::size_t offset,
                    const ColorState& state, PixelMask mask, const glm::vec4& color);

/// Writes the colours of the mask's pixels: of_pixel(i) in floats.
template <class OfPixel>
void write_block(const Kernels& kernels, ColorBuffer& target, TileIndex tile, std::size_t offset,
                 const ColorState& state, PixelMask mask, OfPixel of_pixel) {
  if (target.format() == ColorFormat::rgba32f) {
    glm::vec4* const stored = target.rgba32f().tile(tile.x, tile.y) + offset;
    for_each_pixel(
        mask, [&](std::size_t i) { stored[i] = blend_rgba32f(state, of_pixel(i), stored[i]); });
    return;
  }
  Rgba8Block source;
  for_each_pixel(mask, [&](std::size_t i) { source[i] = to_rgba8(of_pixel(i)); });
  write_rgba8(kernels, target, tile, offset, state, mask, source);
}

inline bool any(const std::array<bool, 4>& write) {
  return write[0] || write[1] || write[2] || write[3];
}

}  // namespace gnomon::raster
