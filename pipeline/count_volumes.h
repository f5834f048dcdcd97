// The draws that count shadow volumes in the stencil buffer (Haller 2003, section 3.1.2 and
// appendix A; depth fail after Everitt and Kilgard 2002).
// Invariant: after the counts a pixel's stencil is 0 (modulo 256, or 128 under a 7-bit write mask)
// exactly when its visible point lies in no counted volume.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "pipeline/make_volumes.h"
#include "raster/frame.h"

namespace gnomon::pipeline {

/// How often a caster hides a point from a light in one line, at most, where counts must not wrap
/// (CountOptions::in_batches). Where some do so more often, a point may come out as not in shadow
/// whose count is a multiple of what the bits of a batch can tell apart (128 of eight bits, 64 of
/// seven; 256 and 128 where all volumes are one batch).
inline constexpr std::size_t kLayers = 3;

struct CountOptions {
  /// Appendix A to the letter: single-sided draws with culling and saturating INCR and DECR, all
  /// increments before all decrements. Otherwise one two-sided draw a volume with wrapping
  /// operations, if single_sided does not say otherwise.
  bool appendix_letter = false;
  /// OpenGL 1.x's single-sided stencil: two draws a volume with culling, all that add before all
  /// that take away, as in the appendix, but with wrapping operations. The stencil is the two-sided
  /// one's.
  bool single_sided = false;
  /// Stencil bits that count: the low ones.
  std::uint8_t write_mask = 0xff;
  /// More volumes than the bits can count are counted in batches; after each, what is not 0 becomes
  /// the highest of the bits, so that no count comes back to 0. A volume is taken to hold a point
  /// up to kLayers times. The stencil then says whether, not how often. Not with the appendix's
  /// saturating operations, which have an end of their own.
  bool in_batches = false;
  /// All casters are in the depth buffer: front caps of z-pass volumes are left out, where they
  /// coincide with what was drawn (PlacedVolume::cap_is_drawn).
  bool casters_drawn = false;
  /// Added to each draw's label.
  std::string light_name;
};

/// Records the counting draws: colour and depth are only read.
/// z-pass: +1 for a front face, -1 for a back face that passes the depth test. z-fail: +1 for a
/// back face, -1 for a front face that fails it. Both with LESS: a front cap coincides with its
/// caster's lit surface, which must come out as not in the volume.
void count_volumes(raster::Frame& frame, std::span<const PlacedVolume> volumes,
                   const CountOptions& options);

}  // namespace gnomon::pipeline
