// Explicit colour, depth and stencil buffers. Planes are kept apart, never packed.
// Window coordinates: (0, 0) is the bottom left pixel (OpenGL 4.6, section 18.2.3).
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include <glm/vec4.hpp>

#include "raster/depth_ranges.h"
#include "raster/tiled_plane.h"

namespace gnomon::raster {

enum class ColorFormat : std::uint8_t { rgba8, rgba32f };
enum class DepthFormat : std::uint8_t { d24, d16 };

/// Four 8-bit channels in the order r, g, b, a.
using Rgba8 = std::array<std::uint8_t, 4>;

/// A colour buffer: four unsigned normalized 8-bit channels, or four float32 channels. Starts at
/// zero.
class ColorBuffer {
 public:
  ColorBuffer(int width, int height, ColorFormat format = ColorFormat::rgba8);

  int width() const { return width_; }
  int height() const { return height_; }
  ColorFormat format() const { return format_; }

  /// The stored value as floats; 8-bit channels as c / 255.
  glm::vec4 at(int x, int y) const;

  /// The planes themselves; misuse if the format is the other one.
  TiledPlane<Rgba8>& rgba8();
  const TiledPlane<Rgba8>& rgba8() const;
  TiledPlane<glm::vec4>& rgba32f();
  const TiledPlane<glm::vec4>& rgba32f() const;

  /// 8-bit pixels, four bytes each, row after row from the bottom row; float channels are clamped
  /// to [0, 1] and rounded to nearest.
  std::vector<std::uint8_t> to_rgba8_rows() const;

 private:
  int width_, height_;
  ColorFormat format_;
  std::variant<TiledPlane<Rgba8>, TiledPlane<glm::vec4>> plane_;
};

/// A depth buffer of unsigned normalized integers in the low 24 or 16 bits of a word. Starts at the
/// largest value (1.0).
class DepthBuffer {
 public:
  DepthBuffer(int width, int height, DepthFormat format = DepthFormat::d24);

  int width() const { return plane_.width(); }
  int height() const { return plane_.height(); }
  DepthFormat format() const { return format_; }
  /// The integer that stands for 1.0: 2^24 - 1 or 2^16 - 1.
  std::uint32_t max_value() const;

  std::uint32_t at(int x, int y) const { return plane_.at(x, y); }
  /// To write values by hand; ask anew after a frame was executed, because the ranges that are kept
  /// of the values are forgotten here and not when a value is written.
  TiledPlane<std::uint32_t>& plane();
  const TiledPlane<std::uint32_t>& plane() const { return plane_; }

  /// A tile's values with what is known of their ranges; whoever writes the ones keeps the others
  /// true. Tiles may be had on several threads, one tile on one.
  DepthTile tile(int tile_x, int tile_y);

  /// Integers row after row from the bottom row.
  std::vector<std::uint32_t> to_rows() const;

 private:
  DepthFormat format_;
  TiledPlane<std::uint32_t> plane_;
  std::vector<DepthRanges> ranges_;
  /// Grows when values may have been written by hand; ranges of an older version are not known.
  std::uint64_t version_ = 0;
};

/// An 8-bit stencil buffer. Starts at zero.
class StencilBuffer {
 public:
  StencilBuffer(int width, int height) : plane_(width, height) {}

  int width() const { return plane_.width(); }
  int height() const { return plane_.height(); }

  std::uint8_t at(int x, int y) const { return plane_.at(x, y); }
  TiledPlane<std::uint8_t>& plane() { return plane_; }
  const TiledPlane<std::uint8_t>& plane() const { return plane_; }

  /// Bytes row after row from the bottom row.
  std::vector<std::uint8_t> to_rows() const;

 private:
  TiledPlane<std::uint8_t> plane_;
};

}  // namespace gnomon::raster
