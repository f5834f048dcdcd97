// How far two surfaces are apart, measured at many points of each.
#pragma once

#include "pipeline/mesh.h"

namespace gnomon::pipeline {

/// The largest distance from a sample of either surface to the other surface, in metres. Samples
/// are 15 a triangle: its corners, three points of each edge and three inside. A lower bound of the
/// Hausdorff distance, and close to it where triangles are small beside it. 0 if either has no
/// triangle. Precondition: every position is finite.
double surface_distance(const Model& a, const Model& b);

}  // namespace gnomon::pipeline
