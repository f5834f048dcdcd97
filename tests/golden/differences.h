// What a failing golden scene leaves behind.
#pragma once

#include <filesystem>
#include <string>

#include "golden/scenes.h"

namespace gnomon::golden {

/// Two runs of a scene, buffer by buffer.
struct Differences {
  /// Pixels that differ in any bit.
  std::size_t color_pixels = 0, depth_pixels = 0, stencil_pixels = 0;
  /// Largest difference: of a colour channel (in 1/255, or as floats), of the depth integers, of
  /// the stencil values.
  double color = 0.0, depth = 0.0, stencil = 0.0;
};

/// Precondition: the same size and formats.
Differences differences(const Targets& got, const Targets& expected);

/// Writes pictures of what was got and of the pixels that differ (white) into `folder`, which is
/// made.
void write_differences(const std::filesystem::path& folder, const Targets& got,
                       const Targets& expected);

/// One line a buffer.
std::string sentence(const Differences& differences);

}  // namespace gnomon::golden
