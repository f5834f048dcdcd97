// Colours on their way to the pixels of a block: rounded, blended, masked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec4.hpp>

#include "raster/buffers.h"
#include "raster/kernels.h"
#include "raster/state.h"
#include "raster/tile_blocks.h"

namespace gnomon::raster {

/// Colours of a block's 64 pixels in four planes: r, g, b, a. Only those of a mask are set.
using ColorPlanes = std::array<float, 4 * kPixelsPerBlock>;

inline void set_color(ColorPlanes& colors, std::size_t i, const glm::vec4& color) {
  for (std::size_t c = 0; c < 4; ++c) colors[c * kPixelsPerBlock + i] = color[static_cast<int>(c)];
}

/// The same as RGBA8.
using Rgba8Block = std::array<Rgba8, kPixelsPerBlock>;

/// Writes to the blocks of one tile of a colour buffer, under one colour state.
class BlockWriter {
 public:
  BlockWriter(const Kernels& kernels, ColorBuffer& target, TileIndex tile, const ColorState& state);

  /// Writes the mask's pixels of block b.
  void write(std::size_t b, PixelMask mask, const ColorPlanes& colors) const;
  void write(std::size_t b, PixelMask mask, const glm::vec4& color) const;
  /// Precondition: an RGBA8 target.
  void write(std::size_t b, PixelMask mask, const Rgba8Block& colors) const;

  bool is_rgba8() const { return rgba8_ != nullptr; }
  /// For Kernels::shade_and_store; valid as long as the state is.
  ColorTile tile() const;

 private:
  const Kernels& kernels_;
  const ColorState& state_;
  /// No blending and no channel left out.
  const bool plain_;
  Rgba8 constant_{};
  Rgba8* rgba8_ = nullptr;
  glm::vec4* rgba32f_ = nullptr;
};

inline bool any(const std::array<bool, 4>& write) {
  return write[0] || write[1] || write[2] || write[3];
}

}  // namespace gnomon::raster
