// Runs a case on gnomon and on OpenGL and counts what differs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "case.h"
#include "peer/osmesa/osmesa_context.h"

namespace gnomon::peer {

/// How many values of each buffer: stencil bytes, depths, bytes of colour.
struct Differing {
  std::size_t stencil = 0, depth = 0, color = 0;
  std::size_t all() const { return stencil + depth + color; }
  Differing& operator+=(const Differing& other);
};

Differing compare(const Buffers& a, const Buffers& b);

/// The first pixel that two rasterizers disagree on.
struct Disagreement {
  /// Commands that had been run.
  std::size_t commands = 0;
  int x = 0, y = 0;
  /// Both sides' values of each buffer, as text.
  std::string values;
};

/// The first differing pixel, rows from the bottom one.
std::optional<Disagreement> first_difference(const Buffers& ours, const Buffers& theirs, int width,
                                             std::size_t commands);

/// A pixel's values, as text: "stencil 1, theirs 2; depth ...".
std::string values_at(const Buffers& ours, const Buffers& theirs, std::size_t pixel);

/// What two rasterizers that keep their own buffers from the case's first command to its last one
/// differ in, summed over looks at all buffers every `commands_a_look` commands and at the end.
struct Comparison {
  std::size_t looks = 0;
  Differing differing;
  std::optional<Disagreement> first;
};

/// Precondition: the case has the context's size.
Comparison compare_on_opengl(const OsmesaContext& context, const Case& tried,
                             std::size_t commands_a_look);

}  // namespace gnomon::peer
