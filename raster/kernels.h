// The kernel boundary: what happens to the 64 pixels of an 8x8 block. Everything here is integer; a
// set of pixels is a 64-bit mask, bit 8 y + x for pixel (x, y) of the block, and planes are
// block-linear (raster/tiled_plane.h). Kernels cannot fail. They are written twice: in plain C++
// (kernels_scalar.cpp) and once for all vector instruction sets (kernels_simd.cpp); both leave the
// same bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "raster/isa.h"
#include "raster/state.h"

namespace gnomon::raster {

using PixelMask = std::uint64_t;
inline constexpr PixelMask kAllPixels = ~PixelMask{0};

/// Calls body(i) for each pixel of the mask, lowest bit first.
template <class Body>
void for_each_pixel(PixelMask mask, Body body) {
  for (; mask; mask &= mask - 1) body(static_cast<std::size_t>(__builtin_ctzll(mask)));
}

/// Up to three edges of a triangle over a grid of 8x8 samples (the pixels of a block, or a corner
/// of each block of a tile), as 32-bit sums: value + x * step_x + y * step_y at sample (x, y).
/// Edges that hold everywhere are left out; `value` at every sample fits 32 bits.
struct GridEdges {
  int count = 0;
  std::int32_t value[3];
  std::int32_t step_x[3], step_y[3];
};

/// A depth plane at a block's first pixel, half a unit added (raster/depth_plane.h).
struct BlockDepth {
  std::uint64_t base = 0, step_x = 0, step_y = 0;
  int fraction_bits = 8;
  bool narrow = true;
  std::uint32_t low = 0, high = 0xffffff;
};

/// Depth and stencil state of one draw and facing, resolved against the targets that are there.
struct FragmentTests {
  bool depth_test = false, depth_write = false, stencil_test = false;
  CompareFunc depth_func = CompareFunc::always;
  StencilFace stencil;
  std::uint8_t stencil_ref = 0;
};

/// The kernels of one instruction set.
struct Kernels {
  /// Samples where no edge is negative, bit 8 y + x.
  PixelMask (*cover_grid)(const GridEdges& edges) noexcept;

  /// Runs stencil test, depth test, stencil update and depth write on the covered pixels of a
  /// block; returns those that pass all. `depth` and `stencil` point to the block's 64 values;
  /// either may be null if its test is off.
  PixelMask (*test_block)(const FragmentTests& tests, PixelMask covered, const BlockDepth& plane,
                          std::uint32_t* depth, std::uint8_t* stencil) noexcept;

  /// The least and the greatest of a block's 64 depths.
  void (*depth_range)(const std::uint32_t* depth, std::uint32_t& least,
                      std::uint32_t& greatest) noexcept;

  /// Writes 64 RGBA8 source colours over the pixels of the mask: blending, then the colour mask
  /// (raster/blend.h). Four bytes a pixel: r, g, b, a; `constant` is the blend's constant colour.
  void (*blend_block)(const ColorState& state, const std::uint8_t (&constant)[4], PixelMask mask,
                      const std::uint8_t* source, std::uint8_t* stored) noexcept;

  /// Clip-space positions of `count` vertices: ((m0 x + m1 y) + m2 z) + m3 w in float32, each
  /// operation rounded once.
  void (*transform)(const glm::mat4& clip_from_model, const glm::vec4* positions, std::size_t count,
                    glm::vec4* out) noexcept;
};

/// Misuse: an instruction set that available_isas() does not list.
const Kernels& kernels(Isa isa);
/// Those of a vector instruction set; null if this build or this machine has not got it.
const Kernels* simd_kernels(Isa isa);
const Kernels& scalar_kernels();

}  // namespace gnomon::raster
