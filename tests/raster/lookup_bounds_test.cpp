// What a flat colour's depth lookup is said to leave no mark of, before a pixel is looked at.
// Oracle: the lookup itself, compare_depth, at positions between the corners.
#include <gtest/gtest.h>

#include <array>
#include <memory_resource>

#include "random_frames.h"
#include "raster/depth_lookup.h"
#include "raster/kernels.h"
#include "raster/tile_shading.h"

using namespace gnomon::raster;
using gnomon::random_frames::Random;

namespace {

/// Far but for a few texels; s and t on texels' edges come up often.
DepthBuffer sparse_map(Random& random) {
  DepthBuffer map(random.integer(1, 70), random.integer(1, 70),
                  random.chance(0.5f) ? DepthFormat::d24 : DepthFormat::d16);
  for (int i = random.integer(0, 4); i > 0; --i)
    map.plane().at(random.integer(0, map.width() - 1), random.integer(0, map.height() - 1)) =
        static_cast<std::uint32_t>(random.integer(0, static_cast<int>(map.max_value())));
  return map;
}

glm::mat4 random_matrix(Random& random) {
  glm::mat4 m(1.0f);
  if (random.chance(0.3f)) return m;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m[c][r] += random.real(-0.4f, 0.4f);
  // A far position: large numbers whose difference matters.
  if (random.chance(0.2f)) m[3][0] -= 40.0f * m[0][0];
  return m;
}

glm::vec4 random_corner(Random& random, const DepthBuffer& map, const glm::vec4& near) {
  glm::vec4 p = near;
  for (int i = 0; i < 3; ++i) p[i] += random.real(-0.06f, 0.06f);
  if (random.chance(0.3f))
    p.x = static_cast<float>(random.integer(0, map.width())) / static_cast<float>(map.width());
  if (random.chance(0.3f))
    p.y = static_cast<float>(random.integer(0, map.height())) / static_cast<float>(map.height());
  if (random.chance(0.1f)) p.z = 1.0f;
  return p;
}

/// As a fragment's position is found: float32 weights of sum 1 up to rounding, sums in order.
glm::vec4 position_between(Random& random, const std::array<glm::vec4, 3>& corners) {
  double w[3];
  for (double& weight : w) weight = random.chance(0.2f) ? 0.0 : random.real(0.0f, 1.0f);
  const double sum = w[0] + w[1] + w[2];
  if (sum == 0.0) return corners[static_cast<std::size_t>(random.integer(0, 2))];
  const glm::vec3 p(w[0] / sum, w[1] / sum, w[2] / sum);
  return (corners[0] * p.x + corners[1] * p.y) + corners[2] * p.z;
}

Draw subtracting_draw(const DepthLookup& lookup, const std::array<std::uint32_t, 1200>& indices,
                      std::span<const glm::vec4> positions) {
  Flat flat;
  flat.depth_lookup = lookup;
  return {.state = {.color = {.write = {true, true, true, false},
                              .blend = Blend{.color_op = BlendOp::reverse_subtract,
                                             .dst_color = BlendFactor::one}}},
          .mesh = {.positions = positions, .indices = indices},
          .shading = flat};
}

}  // namespace

TEST(LookupBounds, WhatLeavesNoMarkHasNoFragmentThatPasses) {
  Random random(3);
  ColorBuffer color(1, 1);
  constexpr std::array<std::uint32_t, 1200> kIndices{};
  constexpr std::uint32_t kCorners[] = {0, 1, 2};
  for (const Isa isa : available_isas()) {
    if (isa == Isa::scalar) continue;
    int skipped = 0;
    for (int round = 0; round < 6000; ++round) {
      const DepthBuffer map = sparse_map(random);
      DepthLookup lookup{.map = &map,
                         .map_from_position = random_matrix(random),
                         .func = static_cast<CompareFunc>(random.integer(0, 7)),
                         .filter = random.chance(0.5f) ? Filter::nearest : Filter::linear};
      if (random.chance(0.7f)) lookup.func = CompareFunc::greater;
      if (random.chance(0.3f)) lookup.border.reset();
      if (random.chance(0.2f)) lookup.border = random.real(0.0f, 1.0f);
      const glm::vec4 near{random.real(-0.1f, 1.1f), random.real(-0.1f, 1.1f),
                           random.real(0.0f, 1.1f), 1.0f};
      std::array<glm::vec4, 3> corners{};
      for (glm::vec4& corner : corners) corner = random_corner(random, map, near);
      const Draw draw = subtracting_draw(lookup, kIndices, corners);
      const auto shading = make_draw_shading(draw, {.color = &color}, kernels(isa),
                                             *std::pmr::get_default_resource());
      if (!shading->lookup->leaves_no_mark(kernels(isa), corners.data(), kCorners, 3)) continue;
      ++skipped;
      for (int i = 0; i < 40; ++i)
        ASSERT_EQ(compare_depth(lookup, position_between(random, corners)), 0.0f)
            << name(isa) << ", round " << round;
    }
    // It is of use.
    EXPECT_GT(skipped, 2000) << name(isa);
  }
}

TEST(LookupBounds, ABlockWithATexelThatPassesIsMetFromEverySide) {
  // Closed form: one texel is near, in the block of texels (16, 40) to (23, 47), and a block is
  // what is known. A triangle 6 texels wide and high that ends half a texel beside it cannot meet
  // it; one that reaches over its edge by a hundredth of a texel can.
  DepthBuffer map(64, 64);
  map.plane().at(17, 40) = 0;
  ColorBuffer color(1, 1);
  constexpr std::array<std::uint32_t, 1200> kIndices{};
  constexpr std::uint32_t kCorners[] = {0, 1, 2};
  const DepthLookup lookup{.map = &map, .func = CompareFunc::greater};
  for (const Isa isa : available_isas()) {
    if (isa == Isa::scalar) continue;
    for (const glm::vec2 way : {glm::vec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
      for (const bool over : {false, true}) {
        const glm::vec2 middle = glm::vec2(20, 44) + way * (over ? 6.99f : 7.5f);
        std::array<glm::vec4, 3> corners{};
        for (std::size_t k = 0; k < 3; ++k) {
          const glm::vec2 at = middle + 3.0f * glm::vec2(k == 0 ? -1 : 1, k == 1 ? -1 : 1);
          corners[k] = {at.x / 64, at.y / 64, 0.5f, 1.0f};
        }
        const Draw draw = subtracting_draw(lookup, kIndices, corners);
        const auto shading = make_draw_shading(draw, {.color = &color}, kernels(isa),
                                               *std::pmr::get_default_resource());
        EXPECT_EQ(shading->lookup->leaves_no_mark(kernels(isa), corners.data(), kCorners, 3), !over)
            << name(isa) << ' ' << way.x << ' ' << way.y;
      }
  }
}
