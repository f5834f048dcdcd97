// Pairs of a mesh's triangles that cut each other. Candidates come from Embree's collision of
// boxes; the decision is rounded (signs of double determinants), so it informs and decides nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "pipeline/topology.h"

namespace gnomon::pipeline {

/// More pairs than these are not kept: which, is not defined then.
inline constexpr std::size_t kMostIntersections = 1'000'000;

/// Pairs (smaller first, ascending) of triangles of the topology that share no vertex and of which
/// one's edge meets the other. Triangles in one plane are no pair. Time grows with the pairs whose
/// boxes overlap.
std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(const Topology& topology);

}  // namespace gnomon::pipeline
