// A layer over the whole screen that is counted where it fails the depth test, in clip coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/mesh.h"

namespace gnomon::bench {

/// A plane from corner to corner that leans away from the eye, z from -0.8 to -0.4: in front of the
/// layer everywhere.
pipeline::Mesh leaning_plane();

/// z = 0, counter-clockwise.
pipeline::Mesh layer();

/// 24-bit depths of a fixed seed, rows from the bottom one: half of them in front of the layer.
std::vector<std::uint32_t> random_depths(int width, int height);

}  // namespace gnomon::bench
