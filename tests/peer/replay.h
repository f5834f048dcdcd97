// A recorded frame replayed on OpenGL, command by command, with its whole state.
//
// Where the comparison begins: vertices are handed over as clip coordinates that raster's own front
// end computed (float32, ((m0 x + m1 y) + m2 z) + m3 w, each rounded once), and OpenGL's matrices
// are the identity. A driver may order a matrix product as it likes, so starting earlier would
// compare two roundings of the same formula; starting here compares clipping, projection, snap,
// coverage, depth and every test behind them.
//
// Conventions that differ: one unit of polygon offset is one unit of the depth buffer in raster and
// two in Mesa's llvmpipe at 24 bits, so units are halved here.
//
// Colour: Flat shading (constant, vertex colours, texture, depth look-up) is replayed; a look-up's
// coordinates are map_from_position times the position, a vertex at a time, and its map is what
// the depth buffer holds now. Lit shading is drawn white:
// stencil and depth do not depend on it, but colour of a pass after a lit draw cannot be compared.
// Passes whose colour target is not the replay's own draw no colour; depth and stencil are shared,
// as they are in such frames.
#pragma once

#include <cstdint>
#include <vector>

#include "peer/osmesa/osmesa_context.h"
#include "raster/frame.h"

namespace gnomon::peer {

/// Rows from the bottom one, as raster's to_rows.
struct Buffers {
  std::vector<std::uint8_t> stencil;
  /// The 24 bits as they are stored.
  std::vector<std::uint32_t> depth;
  /// r, g, b, a.
  std::vector<std::uint8_t> color;
};

/// The context's buffers become what raster's are at first: colour and stencil 0, depth 1.
void reset(const OsmesaContext& context);

/// Runs the pass's commands on the current context. `color` is the buffer that the context's colour
/// stands for. Preconditions: the pass's targets have the context's size; depth, if any, is D24.
/// Errors: std::runtime_error that names the first OpenGL error.
void replay(const OsmesaContext& context, const raster::Pass& pass,
            const raster::ColorBuffer* color);

/// What the context holds now.
Buffers read_back(const OsmesaContext& context);

}  // namespace gnomon::peer
