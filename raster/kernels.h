// The kernel boundary: what happens to the 64 pixels of an 8x8 block. Everything here is integer; a
// set of pixels is a 64-bit mask, bit 8 y + x for pixel (x, y) of the block, and planes are
// block-linear (raster/tiled_plane.h). Kernels cannot fail.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/state.h"

namespace gnomon::raster {

using PixelMask = std::uint64_t;
inline constexpr PixelMask kAllPixels = ~PixelMask{0};

/// Calls body(i) for each pixel of the mask, lowest bit first.
template <class Body>
void for_each_pixel(PixelMask mask, Body body) {
  for (; mask; mask &= mask - 1) body(static_cast<std::size_t>(__builtin_ctzll(mask)));
}

/// The three edges of a triangle at a block's first pixel centre: value - bias over 256, rounded
/// down. A pixel's step is then the edge's a or b itself, and the sign is exact, because all pixel
/// centres of an edge are equal modulo 256. Edges that hold in the whole block are left out.
struct BlockEdges {
  int count = 0;
  std::int32_t value[3];
  std::int32_t step_x[3], step_y[3];
};

/// Pixels where no edge is negative.
PixelMask cover_block(const BlockEdges& edges) noexcept;

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

/// Runs stencil test, depth test, stencil update and depth write on the covered pixels of a block;
/// returns those that pass all. `depth` and `stencil` point to the block's 64 values; either may be
/// null if its test is off.
PixelMask test_block(const FragmentTests& tests, PixelMask covered, const BlockDepth& plane,
                     std::uint32_t* depth, std::uint8_t* stencil) noexcept;

/// func(a, b) as in "reference func stored".
bool compare(CompareFunc func, std::uint32_t a, std::uint32_t b) noexcept;

/// The stencil value after op, before the write mask.
std::uint8_t apply(StencilOp op, std::uint8_t value, std::uint8_t ref) noexcept;

}  // namespace gnomon::raster
