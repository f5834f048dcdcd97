// The peer suite: seeded cases of a kind on both rasterizers, the counts of what differs with its
// causes, and the first failure, which is what shrink (shrink.h) makes small. A case of the kinds
// grid and lookup fails with any differing value, one of the kind free with one that nothing
// explains (explain_draw.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "cases.h"
#include "compare.h"
#include "explain_draw.h"
#include "peer/osmesa/osmesa_context.h"

namespace gnomon::peer {

struct Tally {
  std::size_t frames = 0, draws = 0, triangles = 0;
  /// Pixels that were compared, all looks at the buffers together.
  std::size_t pixels = 0;
  Differing differing;
  /// Whether differences are explained, and how: of the kind free, of softpipe's grid too.
  bool explained = false;
  DrawCauses causes;
};

/// Runs one case, adds what it finds to the tally and returns the first failure. Where
/// differences are explained gnomon's buffers become OpenGL's after every command, so that no
/// difference is carried on.
std::optional<Disagreement> run_case(const OsmesaContext& context, Kind kind, const Case& tried,
                                     Tally& tally);

/// The tally as a table for people.
std::string table(Kind kind, const Tally& tally);
/// One line of JSON.
std::string json(Kind kind, const Tally& tally, const std::string& renderer);

}  // namespace gnomon::peer
