// What a stencil operation makes of one value (OpenGL 4.6, section 17.3.3).
#pragma once

#include <cstdint>

#include "raster/state.h"

namespace gnomon::raster {

/// The value after op, before the write mask.
constexpr std::uint8_t stencil_after(StencilOp op, std::uint8_t value, std::uint8_t ref) {
  switch (op) {
    case StencilOp::keep:
      return value;
    case StencilOp::zero:
      return 0;
    case StencilOp::replace:
      return ref;
    case StencilOp::incr:
      return value == 255 ? value : static_cast<std::uint8_t>(value + 1);
    case StencilOp::incr_wrap:
      return static_cast<std::uint8_t>(value + 1);
    case StencilOp::decr:
      return value == 0 ? value : static_cast<std::uint8_t>(value - 1);
    case StencilOp::decr_wrap:
      return static_cast<std::uint8_t>(value - 1);
    case StencilOp::invert:
      return static_cast<std::uint8_t>(~value);
  }
  return value;
}

/// The value after op under a write mask.
constexpr std::uint8_t stencil_after(StencilOp op, std::uint8_t value, std::uint8_t ref,
                                     std::uint8_t write_mask) {
  return static_cast<std::uint8_t>((value & ~write_mask) |
                                   (stencil_after(op, value, ref) & write_mask));
}

}  // namespace gnomon::raster
