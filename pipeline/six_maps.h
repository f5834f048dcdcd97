// Six shadow maps about a lamp, one for each side of a cube (Kuehl: "Shadow Mapping doesn't support
// omnidirectional shadows"; Gerasimov 2004 has one cube map).
// Invariant: with the sides' marks every pixel belongs to at least one side, whatever rounding
// does: neighbouring pyramids share the bits of their common triangle, so the marks of all six
// sides are odd in sum, and each side's map shows a little more than its pyramid.
#pragma once

#include <array>
#include <cstdint>

#include "pipeline/map_plan.h"
#include "pipeline/scene.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// +x, -x, +y, -y, +z, -z.
inline constexpr int kCubeSides = 6;
/// "+x" and so on.
const char* cube_side_name(int side);

/// Plans the maps of a point light; those of sides without a caster or a visible receiver are
/// empty. Errors: as MapPlanner.
std::array<MapPlan, kCubeSides> plan_six_maps(const Scene& scene, const Casters& casters,
                                              const Light& light, const Camera& camera,
                                              const MapSettings& settings);

/// The stencil bit that marks a side's pixels.
inline constexpr std::uint8_t kSideBit = 0x01;

/// Sets kSideBit where the visible point lies in the side's pyramid, and zeroes it elsewhere.
/// Precondition: a camera with an eye; its depth buffer and stencil are the pass's targets.
void mark_side(raster::Frame& frame, const Light& light, const Camera& camera, int side);

}  // namespace gnomon::pipeline
