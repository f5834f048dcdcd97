// On which side of a plane a point lies, exactly (Shewchuk 1997, Adaptive Precision Floating-Point
// Arithmetic and Fast Robust Geometric Predicates).
// Invariant: the sign is that of the real determinant of the doubles given. So the three edges
// that a line passes of one triangle, and of its neighbours, never contradict each other.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace gnomon::pipeline {

/// Half a unit in the last place of 1: a rounded sum or product is off by at most this part of it.
inline constexpr double kRounding = 0x1p-53;

/// For each component of cross(p, q) the sum of its two products' sizes; the largest of them. The
/// computed component, with p and q themselves rounded, is off by at most 5 kRounding times this.
double largest_minor(const glm::dvec3& p, const glm::dvec3& q);

/// 1, 0 or -1: the sign of det(b - a, c - a, p - w a), which is positive for a point p (w = 1) from
/// which a, b, c turn counter-clockwise, or for a direction (w = 0) that leaves the plane on that
/// side. 0 where a coordinate is no number. Coordinates are exact: nothing rounds.
/// Preconditions: p.w is 0 or 1; sizes between 1e-80 and 1e80, or 0 (products do not overflow).
int side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                  const glm::dvec4& p);

}  // namespace gnomon::pipeline
