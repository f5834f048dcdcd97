// A target that holds every stencil value with every depth relation, and what must become of a
// fragment on each of its pixels, by counting. A grid over states needs no more than one quad on it
// to get to every outcome that its state allows.
#pragma once

#include <cstdint>
#include <string>

#include "grid.h"
#include "raster/state.h"
#include "reference/reference.h"

namespace gnomon::conformance {

/// "a func b" by the three relations that each function accepts: their bits are the function's
/// number in OpenGL's order (less 1, equal 2, greater 4).
template <class T>
bool accepts(raster::CompareFunc func, T a, T b) {
  return (static_cast<int>(func) >> (a < b ? 0 : a == b ? 1 : 2) & 1) != 0;
}

/// What a quad at z_ndc = 0 stores: half the largest depth, a half rounded upwards.
std::uint32_t middle_depth(raster::DepthFormat format);

/// 256 stencil values times three depth relations.
inline constexpr Size kEveryValue{48, 16};

/// Pixel i (row after row) holds stencil value i mod 256 and a depth one below, at or one above the
/// middle, by (i / 256) mod 3. A target of kEveryValue holds each pair once.
Buffers every_value(Size size, raster::DepthFormat format);

/// The outcomes of one fragment at middle depth on each pixel of every_value(kEveryValue).
reference::Outcomes counted_outcomes(const raster::State& state, int ref, bool front_facing);

/// Fails the running test where two counts differ.
void expect_same(const reference::Outcomes& got, const reference::Outcomes& wanted,
                 const std::string& name);

}  // namespace gnomon::conformance
