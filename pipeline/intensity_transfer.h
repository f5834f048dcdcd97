// How much of a pixel's 8-bit value each source's shadow takes, although the camera's response is
// not linear and nobody knows yet which sources will be hidden (Gibson 2003, section 7.1 and figure
// 4): sources are put in two sets by a random number each, and within a set the light of one after
// the other is taken away, as if all of the set were hidden and none of the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/tone_curve.h"

namespace gnomon::pipeline {

/// Which set a source is in: bit 0 of a mixed number (SplitMix64), the same in every frame.
/// `first_share` of the sources, on average, are in the first; the paper has 0.5.
bool in_first_set(std::uint64_t source, double first_share = 0.5);

/// The values, in [0, 255] each and not rounded, that the sources of one vertex take, in the
/// sources' order (falling transfer). `light` is the vertex's radiance, `transfers` what each
/// source gives it; `first_set` is 1 for a source of the first set and 0 for one of the other.
/// Radiance below 0 counts as 0. No value is negative; those of a set add up to T(light) - T(light
/// - sum of the set's transfers).
void intensity_transfers(const ToneCurve& tone, const glm::dvec3& light,
                         std::span<const glm::vec3> transfers,
                         std::span<const std::uint8_t> first_set, std::span<glm::vec3> values);

}  // namespace gnomon::pipeline
