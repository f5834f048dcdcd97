// Perspective-correct attributes at a pixel centre.
// Order of operations: weights E_k * ((1/w_k) / area) in double (E_k is an exact integer), each
// times the reciprocal of their sum (q_0 + q_1) + q_2; mapped to the mesh's triangle if it was
// clipped; rounded to float32; attributes are (p0 a0 + p1 a1) + p2 a2 in float32; into the world a
// normal goes as (m0 x + m1 y) + m2 z and a position as (m0 x + m1 y) + (m2 z + m3 w).
#pragma once

#include "raster/geometry.h"
#include "raster/shading.h"

namespace gnomon::raster {

/// A vertex's own position and normal in the world, and its colour.
Fragment vertex_attributes(const MeshView& mesh, const Lit& lit, std::size_t vertex) noexcept;

/// Precondition: the triangle covers pixel (x, y); `source` is that of its chunk.
Fragment interpolate(const Draw& draw, const SetupTriangle& triangle, const TriangleSource& source,
                     int x, int y) noexcept;

}  // namespace gnomon::raster
