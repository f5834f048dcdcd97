// The shrinker without any OpenGL. Oracle: failures whose smallest case is known beforehand.
#include "shrink.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cases.h"
#include "describe.h"

using namespace gnomon;
using namespace gnomon::peer;

namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

glm::dvec2 window(const glm::vec4& p) {
  return (glm::dvec2(p) / static_cast<double>(p.w) + 1.0) * (0.5 * kCaseSize);
}

bool covers(const Triangle& triangle, const glm::dvec2& point) {
  const glm::dvec2 a = window(triangle[0]), b = window(triangle[1]), c = window(triangle[2]);
  const double sign = cross(b - a, c - a) < 0.0 ? -1.0 : 1.0;
  return sign * cross(b - a, point - a) > 0.0 && sign * cross(c - b, point - b) > 0.0 &&
         sign * cross(a - c, point - c) > 0.0;
}

bool increments(const CaseDraw& draw) {
  return draw.state.stencil && draw.state.stencil->front.pass == raster::StencilOp::incr_wrap;
}

/// A triangle of a draw that increments covers pixel (3, 4).
bool increments_pixel(const Case& tried) {
  return std::any_of(tried.commands.begin(), tried.commands.end(), [](const CaseCommand& command) {
    const CaseDraw* draw = std::get_if<CaseDraw>(&command);
    return draw && increments(*draw) &&
           std::any_of(draw->triangles.begin(), draw->triangles.end(), [](const Triangle& t) {
             return covers(t, {3.5, 4.5});
           });
  });
}

/// The first grid case that fails so.
Case failing_case() {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Case tried = grid_case(seed);
    for (CaseCommand& command : tried.commands)
      if (CaseDraw* draw = std::get_if<CaseDraw>(&command)) draw->state.viewport.reset();
    if (increments_pixel(tried)) return tried;
  }
  throw std::runtime_error("no seed fails");
}

}  // namespace

TEST(Shrink, LeavesTheOneTriangleAndTheOneStateThatTheFailureIsMadeOf) {
  const Case failing = failing_case();
  ASSERT_GT(failing.triangles(), 100u);
  const Case smallest = shrink(failing, increments_pixel);
  EXPECT_TRUE(increments_pixel(smallest));
  ASSERT_EQ(smallest.commands.size(), 1u);
  const CaseDraw& draw = std::get<CaseDraw>(smallest.commands[0]);
  EXPECT_EQ(draw.triangles.size(), 1u);
  raster::State expected;
  expected.stencil.emplace();
  expected.stencil->front.pass = raster::StencilOp::incr_wrap;
  EXPECT_TRUE(draw.state == expected) << describe(smallest);
  EXPECT_EQ(draw.stencil_ref, raster::StencilRef());
}

TEST(Shrink, KeepsTwoCommandsThatFailOnlyTogether) {
  const auto fails = [](const Case& tried) {
    std::size_t clears = 0;
    for (const CaseCommand& command : tried.commands)
      clears += std::holds_alternative<raster::Clear>(command);
    return clears >= 1 && tried.triangles() >= 1;
  };
  const Case smallest = shrink(grid_case(0), fails);
  EXPECT_EQ(smallest.commands.size(), 2u);
  EXPECT_EQ(smallest.triangles(), 1u);
}

TEST(Shrink, MovesVerticesToRounderPlacesAsLongAsTheFailureStays) {
  const Case smallest = shrink(failing_case(), increments_pixel);
  for (const glm::vec4& p : std::get<CaseDraw>(smallest.commands.at(0)).triangles.at(0)) {
    EXPECT_EQ(p.w, 1.0f);
    EXPECT_EQ(p.z, 0.0f);
    // Sixteenths of half a target's side are whole multiples of two pixels.
    for (int axis = 0; axis < 2; ++axis)
      EXPECT_EQ(p[axis] * 16.0f, std::round(p[axis] * 16.0f)) << describe(smallest);
  }
}

TEST(Shrink, StopsAfterItsQuestionsWithACaseThatFails) {
  std::size_t asked = 0;
  const Case smaller = shrink(
      failing_case(),
      [&](const Case& tried) {
        ++asked;
        return increments_pixel(tried);
      },
      10);
  EXPECT_LE(asked, 10u);
  EXPECT_TRUE(increments_pixel(smaller));
}
