// Where two buffers of one size differ, and a picture of it in characters: cropped to what differs,
// at most 64x32 characters, one character a pixel or, where there are more, a block of pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "raster/buffers.h"

namespace gnomon::testing {

inline constexpr int kMaxPictureWidth = 64, kMaxPictureHeight = 32;

/// How an actual value lies to the expected one.
struct PixelDifference {
  /// '.' equal; '+' more; '-' less; '*' more in one channel and less in another, or different bits
  /// that neither says (a NaN, a negative zero).
  char sign = '.';
  /// Of the channel that differs most, in the buffer's own units.
  double magnitude = 0.0;
};

/// Differences of at most `units` are equal. Stencil values are compared as 0 to 255, floats by
/// their bits.
PixelDifference difference(const raster::StencilBuffer& actual,
                           const raster::StencilBuffer& expected, int x, int y,
                           std::uint32_t units);
PixelDifference difference(const raster::DepthBuffer& actual, const raster::DepthBuffer& expected,
                           int x, int y, std::uint32_t units);
PixelDifference difference(const raster::ColorBuffer& actual, const raster::ColorBuffer& expected,
                           int x, int y, std::uint32_t units);

/// A pixel's value for people.
std::string value(const raster::StencilBuffer& stencil, int x, int y);
std::string value(const raster::DepthBuffer& depth, int x, int y);
std::string value(const raster::ColorBuffer& color, int x, int y);

/// "8x6 D24 depth buffer". Buffers of one kind can be compared.
std::string kind(const raster::StencilBuffer& stencil);
std::string kind(const raster::DepthBuffer& depth);
std::string kind(const raster::ColorBuffer& color);

/// A column of the picture beside the differences, from characters of single pixels.
struct Column {
  std::string title;
  /// Row after row from the bottom row, as large as the map.
  std::string glyphs;
};

/// The signs of all pixels and what is to be said of them.
class DifferenceMap {
 public:
  DifferenceMap(int width, int height);

  /// Precondition: each pixel at most once, row after row from the bottom row; a pixel that is left
  /// out is not compared.
  void add(int x, int y, const PixelDifference& pixel);

  struct Pixel {
    int x = 0, y = 0;
  };
  std::size_t compared() const { return compared_; }
  std::size_t differing() const { return differing_; }
  /// From the bottom row, each from the left. Precondition, as of all that follows: some pixel
  /// differs.
  Pixel first() const { return first_; }
  Pixel largest() const { return largest_; }
  double largest_magnitude() const { return magnitude_; }

  /// Lines with their y, the top one first. Columns are shown if all fit beside each other.
  std::string picture(const std::vector<Column>& columns) const;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  char block_sign(int x, int y, int block) const;

  int width_;
  std::string signs_;
  std::size_t compared_ = 0, differing_ = 0;
  Pixel first_, largest_;
  double magnitude_ = -1.0;
  /// Bounds of what differs, inclusive.
  int x0_, y0_, x1_ = -1, y1_ = -1;
};

}  // namespace gnomon::testing
