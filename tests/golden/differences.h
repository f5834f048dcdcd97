// Where two runs of a scene part.
#pragma once

#include <functional>
#include <string>

#include "raster/frame_format.h"

namespace gnomon::golden {

/// Two buffers, pixel by pixel.
struct Difference {
  /// Pixels that differ in any bit.
  std::size_t pixels = 0;
  /// Largest difference: of a colour channel (in 1/255, or as floats), of the depth integers, of
  /// the stencil values.
  double largest = 0.0;
};

/// Precondition: the same kind, size and format. `at` is told of every pixel that differs.
Difference difference(
    const raster::Buffer& got, const raster::Buffer& expected,
    const std::function<void(int x, int y)>& at = [](int, int) {});

/// A line a buffer: "depth d24 160x120: 3 pixels differ, by at most 1".
std::string sentences(const raster::RecordedFrame& got, const raster::RecordedFrame& expected);

}  // namespace gnomon::golden
