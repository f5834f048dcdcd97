// Seeded random cases of the peer suite; the same seed gives the same case everywhere. A case has a
// few pipeline states that its draws take turns with, because a driver that compiles its states
// takes far longer to get a new one than to draw; what needs no compiling (reference, scissor,
// viewport, depth range) is new in every draw.
#pragma once

#include <cstdint>
#include <string_view>

#include "case.h"

namespace gnomon::peer {

enum class Kind : std::uint8_t {
  /// Nothing is left to rounding: vertices on the 1/256 pixel grid inside the target, depths that
  /// are constant on a triangle or planes with whole slopes, blending whose products are whole.
  grid,
  /// Real positions of every size, in front of, across and behind the eye, in every state.
  free,
  /// Depth-compare look-ups at coordinates that float32 holds exactly.
  lookup
};

std::string_view name(Kind kind);

/// Every kind's targets are this wide and high; a power of two, so that the window coordinates of
/// the grid are exact in float32, whatever the order of operations of a viewport transform is.
inline constexpr int kCaseSize = 64;

Case grid_case(std::uint32_t seed);
Case free_case(std::uint32_t seed);
Case lookup_case(std::uint32_t seed);
Case make_case(Kind kind, std::uint32_t seed);

}  // namespace gnomon::peer
