// Every operation on the way to a pixel is rounded once: a fused multiply-add, a reciprocal
// estimate or a division turned into a product leaves another byte here. Oracle: the written order
// of operations in tests/reference/float32.h. Each test also computes what the shortcut would leave
// and asserts that it differs, so that the test can fail.
#include <gtest/gtest.h>

#include <cmath>

#include "grid.h"
#include "raster/depth_lookup.h"
#include "raster/kernels.h"
#include "raster/random_frames.h"
#include "reference/float32.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using namespace gnomon::reference::float32;
using gnomon::random_frames::Random;

namespace {

glm::vec4 random_vec4(Random& random, float low, float high) {
  glm::vec4 v;
  for (int i = 0; i < 4; ++i) v[i] = random.real(low, high);
  return v;
}

/// ((a0 b0 + a1 b1) + a2 b2) + a3 b3.
float dot4(const glm::vec4& a, const glm::vec4& b) {
  return plus(plus(plus(times(a.x, b.x), times(a.y, b.y)), times(a.z, b.z)), times(a.w, b.w));
}
/// The same with one product fused into its sum: the first, second, third or fourth.
float fused_dot4(const glm::vec4& a, const glm::vec4& b, int product) {
  float sum = product == 0   ? std::fma(a.x, b.x, times(a.y, b.y))
              : product == 1 ? std::fma(a.y, b.y, times(a.x, b.x))
                             : plus(times(a.x, b.x), times(a.y, b.y));
  sum = product == 2 ? std::fma(a.z, b.z, sum) : plus(sum, times(a.z, b.z));
  return product == 3 ? std::fma(a.w, b.w, sum) : plus(sum, times(a.w, b.w));
}

glm::vec4 row(const glm::mat4& m, int i) { return {m[0][i], m[1][i], m[2][i], m[3][i]}; }

/// A vertex at which fusing any one product would change the result's last bit in row i.
glm::vec4 telling_vertex(Random& random, const glm::mat4& m, int i) {
  while (true) {
    const glm::vec4 p = random_vec4(random, -2.0f, 2.0f);
    bool telling = true;
    for (int product = 0; product < 4; ++product)
      telling = telling && fused_dot4(row(m, i), p, product) != dot4(row(m, i), p);
    if (telling) return p;
  }
}

glm::mat4 random_matrix(Random& random) {
  glm::mat4 m;
  for (int c = 0; c < 4; ++c) m[c] = random_vec4(random, -1.0f, 1.0f);
  return m;
}

/// 1 / q as a hardware estimate of `bits` bits and one step of Newton's method.
template <class T>
T estimated_reciprocal(T q, int bits) {
  int exponent = 0;
  const T mantissa = std::frexp(T{1} / q, &exponent);
  const T estimate = std::ldexp(std::floor(std::ldexp(mantissa, bits)), exponent - bits);
  return static_cast<T>(estimate * static_cast<T>(T{2} - static_cast<T>(q * estimate)));
}

}  // namespace

TEST(Rounding, TheTransformOfEveryInstructionSetFusesNothing) {
  Grid grid("rounding: transform kernel");
  Random random(14);
  for (int round = 0; round < 60; ++round) {
    const glm::mat4 m = random_matrix(random);
    // Counts around the vectors' widths, so that each lane and each rest is seen.
    for (std::size_t count = 1; count <= 9; ++count) {
      std::vector<glm::vec4> positions, got(count);
      for (std::size_t i = 0; i < count; ++i)
        positions.push_back(telling_vertex(random, m, static_cast<int>(i % 4)));
      std::uint64_t differing = 0;
      for (const Isa isa : available_isas()) {
        kernels(isa).transform(m, positions.data(), count, got.data());
        for (std::size_t i = 0; i < count; ++i)
          for (int r = 0; r < 4; ++r) {
            const float wanted = dot4(row(m, r), positions[i]);
            EXPECT_EQ(got[i][r], wanted) << gnomon::raster::name(isa) << " row " << r;
            differing += got[i][r] == wanted ? 0 : sizeof wanted;
          }
      }
      grid.count(count, available_isas().size(), differing);
    }
  }
}

TEST(Rounding, AFusedTransformWouldChangeStoredDepths) {
  Grid grid("rounding: transform to depth");
  Random random(15);
  int changed = 0;
  for (int round = 0; round < 40; ++round) {
    // A triangle over the whole target whose corners' z are rounded sums.
    glm::mat4 m(1.0f);
    const glm::vec4 z_row = random_vec4(random, 0.1f, 0.2f);
    for (int c = 0; c < 4; ++c) m[c][2] = z_row[c];
    std::vector<glm::vec4> positions{{-1, -1, 0, 1}, {3, -1, 0, 1}, {-1, 3, 0, 1}};
    for (glm::vec4& p : positions) p.z = random.real(0.1f, 0.9f);
    std::vector<glm::vec4> once = positions, fused = positions;
    for (std::size_t i = 0; i < 3; ++i) {
      once[i].z = dot4(z_row, positions[i]);
      // The product with z; those with x, y and w, which are 1, -1 or 3, lose less.
      fused[i].z = fused_dot4(z_row, positions[i], 2);
    }
    const auto depths = [&](const glm::mat4& matrix, const std::vector<glm::vec4>& corners) {
      const Expected expected =
          grid.check("round " + std::to_string(round), Buffers({63, 65}), [&](Frame& frame, auto&) {
            record_draw(frame,
                        {.state = {.depth = DepthState{CompareFunc::always, true}},
                         .clip_from_model = matrix},
                        {corners});
          });
      return expected.only().depth.to_rows();
    };
    EXPECT_EQ(depths(m, positions), depths(glm::mat4(1.0f), once)) << round;
    changed += depths(glm::mat4(1.0f), fused) != depths(glm::mat4(1.0f), once);
  }
  EXPECT_GT(changed, 10);
}

TEST(Rounding, InterpolatedColorsAreSumsOfRoundedProducts) {
  Grid grid("rounding: interpolation");
  Random random(16);
  int told = 0;
  for (int round = 0; round < 20; ++round) {
    constexpr Size kSize{63, 65};
    std::array<glm::dvec2, 3> v{glm::dvec2{-3, -2}, {110, 5}, {7, 140}};
    for (glm::dvec2& p : v) p += glm::dvec2(random.integer(-256, 256)) / 256.0;
    const std::vector<glm::vec4> colors{random_vec4(random, 0, 1), random_vec4(random, 0, 1),
                                        random_vec4(random, 0, 1)};
    const Expected expected = grid.check(
        "round " + std::to_string(round), Buffers(kSize, DepthFormat::d24, ColorFormat::rgba32f),
        [&](Frame& frame, auto&) {
          std::vector<glm::vec4> corners;
          for (const glm::dvec2& p : v) corners.push_back(at_window(p.x, p.y, kSize));
          record_draw(frame, {}, {.positions = corners, .colors = colors});
        });
    // Edge values over 1/65536 square pixels are integers, exact in double; w is 1.
    const auto edge = [&](std::size_t a, std::size_t b, const glm::dvec2& p) {
      return 65536.0 * ((v[b].x - v[a].x) * (p.y - v[a].y) - (v[b].y - v[a].y) * (p.x - v[a].x));
    };
    const double area = edge(0, 1, v[2]);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        const glm::dvec2 p{x + 0.5, y + 0.5};
        const double scale = 1.0 / area;
        const std::array<double, 3> q{edge(1, 2, p) * scale, edge(2, 0, p) * scale,
                                      edge(0, 1, p) * scale};
        if (q[0] < 0 || q[1] < 0 || q[2] < 0) continue;
        const double inverse = 1.0 / ((q[0] + q[1]) + q[2]);
        const auto w0 = static_cast<float>(q[0] * inverse), w1 = static_cast<float>(q[1] * inverse),
                   w2 = static_cast<float>(q[2] * inverse);
        for (int c = 0; c < 4; ++c) {
          const float first = plus(times(colors[0][c], w0), times(colors[1][c], w1));
          ASSERT_EQ(expected.only().color.rgba32f().at(x, y)[c],
                    plus(first, times(colors[2][c], w2)));
          told += std::fma(colors[2][c], w2, first) != plus(first, times(colors[2][c], w2));
        }
      }
  }
  EXPECT_GT(told, 1000);
}

TEST(Rounding, BlendedFloatsAreSumsOfRoundedProducts) {
  Grid grid("rounding: blending");
  Random random(17);
  int told = 0;
  const Blend over_blend{.src_color = BlendFactor::src_alpha,
                         .dst_color = BlendFactor::one_minus_src_alpha};
  for (int round = 0; round < 100; ++round) {
    Buffers before({7, 5}, DepthFormat::d24, ColorFormat::rgba32f);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) before.color.rgba32f().at(x, y) = random_vec4(random, 0.0f, 1.0f);
    const glm::vec4 source = random_vec4(random, 0.0f, 1.0f);
    const Expected expected =
        grid.check("round " + std::to_string(round), before, [&](Frame& frame, auto&) {
          record_draw(frame, {.state = {.color = {.blend = over_blend}}, .shading = Flat{source}},
                      {full_quad()});
        });
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x)
        for (int c = 0; c < 3; ++c) {
          const float stored = before.color.rgba32f().at(x, y)[c];
          const float rest = plus(1.0f, -source.a), product = times(source[c], source.a);
          const float wanted = plus(product, times(stored, rest));
          ASSERT_EQ(expected.only().color.rgba32f().at(x, y)[c], wanted);
          told += std::fma(stored, rest, product) != wanted;
        }
  }
  EXPECT_GT(told, 1000);
}

TEST(Rounding, TexturesAreFilteredInRoundedProductsAndQuotients) {
  Grid grid("rounding: texture filtering");
  Random random(18);
  int fused = 0, multiplied = 0;
  for (int round = 0; round < 2000; ++round) {
    Texture texture;
    texture.width = texture.height = 2;
    texture.wrap_s = texture.wrap_t = Wrap::clamp_to_edge;
    for (int i = 0; i < 4; ++i)
      texture.texels.push_back({static_cast<std::uint8_t>(random.integer(0, 255)), 0, 0, 255});
    const float s = random.real(0.25f, 0.75f), t = random.real(0.25f, 0.75f);
    const float u = plus(times(s, 2.0f), -0.5f), v = plus(times(t, 2.0f), -0.5f);
    const auto texel = [&](std::size_t i) {
      const auto value = static_cast<float>(texture.texels[i][0]);
      multiplied += times(value, 1.0f / 255.0f) != over(value, 255.0f);
      return over(value, 255.0f);
    };
    const auto mix = [](float a, float b, float f) {
      return plus(times(a, plus(1.0f, -f)), times(b, f));
    };
    const float bottom = mix(texel(0), texel(1), u), top = mix(texel(2), texel(3), u);
    const float wanted = mix(bottom, top, v);
    fused += std::fma(top, v, times(bottom, plus(1.0f, -v))) != wanted;
    const float got = sample(texture, s, t).r;
    grid.count(1, 1, got == wanted ? 0 : sizeof got);
    ASSERT_EQ(got, wanted) << round;
  }
  EXPECT_GT(fused, 200);
  EXPECT_GT(multiplied, 200);
}

TEST(Rounding, LightingIsSumsOfRoundedProducts) {
  Grid grid("rounding: lighting");
  Random random(19);
  int told = 0;
  for (int round = 0; round < 2000; ++round) {
    Lit lit;
    Light light;
    const glm::vec4 n = random_vec4(random, 0.1f, 1.0f), l = random_vec4(random, 0.1f, 1.0f);
    const glm::vec4 color = random_vec4(random, 0.1f, 1.0f);
    light.position = {l.x, l.y, l.z, 0.0f};
    light.diffuse = glm::vec3(color.x);
    lit.scene_ambient = glm::vec3(color.y);
    lit.material.ambient = glm::vec3(color.z);
    lit.material.diffuse = glm::vec3(color.w);
    lit.lights = {light};
    Fragment fragment;
    fragment.normal = glm::vec3(n);
    fragment.color = glm::vec4(n.w);

    const auto dot = [](const glm::vec3& a, const glm::vec3& b) {
      return plus(plus(times(a.x, b.x), times(a.y, b.y)), times(a.z, b.z));
    };
    const auto unit = [&](const glm::vec4& v) {
      const float length = square_root(dot(glm::vec3(v), glm::vec3(v)));
      return glm::vec3(over(v.x, length), over(v.y, length), over(v.z, length));
    };
    const float diffuse = times(color.x, dot(unit(n), unit(l)));
    const float ambient_term = times(times(color.z, color.y), n.w);
    const float wanted = plus(ambient_term, times(times(color.w, diffuse), n.w));
    told += std::fma(times(color.w, diffuse), n.w, ambient_term) != wanted;
    const float got = shade(lit, fragment).r;
    grid.count(1, 1, got == wanted ? 0 : sizeof got);
    ASSERT_EQ(got, wanted) << round;
  }
  EXPECT_GT(told, 200);
}

TEST(Rounding, ShadowMapsAreFilteredInRoundedProducts) {
  Grid grid("rounding: shadow map filtering");
  Random random(20);
  // Passes left in the bottom row, right in the top row.
  DepthBuffer map(2, 2);
  map.plane().at(1, 0) = map.plane().at(0, 1) = 0;
  const DepthLookup lookup{.map = &map, .filter = Filter::linear};
  int told = 0;
  for (int round = 0; round < 2000; ++round) {
    const float s = random.real(0.25f, 0.75f), t = random.real(0.25f, 0.75f);
    const float u = plus(times(s, 2.0f), -0.5f), v = plus(times(t, 2.0f), -0.5f);
    const float bottom = times(plus(1.0f, -u), plus(1.0f, -v));
    const float wanted = plus(bottom, times(u, v));
    told += std::fma(u, v, bottom) != wanted;
    const float got = compare_depth(lookup, {s, t, 0.5f, 1.0f});
    grid.count(1, 1, got == wanted ? 0 : sizeof got);
    ASSERT_EQ(got, wanted) << round;
  }
  EXPECT_GT(told, 200);
}

TEST(Rounding, AttenuationIsAQuotientAndNoEstimate) {
  Grid grid("rounding: attenuation");
  Random random(21);
  int told = 0;
  for (int round = 0; round < 300; ++round) {
    const float attenuation = random.real(1.0f, 40.0f);
    const float wanted = over(1.0f, attenuation);
    told += estimated_reciprocal(attenuation, 12) != wanted;
    Lit lit;
    lit.material.diffuse = glm::vec3(1.0f);
    lit.lights = {{.position = {0, 0, 2, 1}, .attenuation = {attenuation, 0, 0}}};
    const Expected expected = grid.check(
        "round " + std::to_string(round), Buffers({7, 5}, DepthFormat::d24, ColorFormat::rgba32f),
        [&](Frame& frame, auto&) {
          // Every position is the origin of the world, straight below the light.
          Lit at_origin = lit;
          at_origin.world_from_model = glm::mat4(0.0f);
          const std::vector<glm::vec4> corners = full_quad();
          record_draw(
              frame, {.shading = at_origin},
              {.positions = corners, .normals = std::vector<glm::vec3>(corners.size(), {0, 0, 1})});
        });
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x)
        ASSERT_EQ(expected.only().color.rgba32f().at(x, y).r, wanted) << attenuation;
  }
  EXPECT_GT(told, 50);
}

TEST(Rounding, TheDivisionByWPutsAVertexOnTheHalfSubPixel) {
  // A left edge half a sub-pixel right of a pixel's centre snaps to the even sub-pixel, the
  // centre's own, and the column is covered. The product with an estimated reciprocal lies a little
  // further right, snaps to the next one and loses the column.
  Grid grid("rounding: division by w");
  int told = 0;
  for (int w = 3; w < 64; w += 2)
    for (int column = 1; column < 31; column += 5) {
      constexpr Size kSize{64, 9};
      const double x_ndc = (column + 128.5 / 256 - 32) / 32;
      const auto x = static_cast<float>(x_ndc * w);
      ASSERT_EQ(static_cast<double>(x) / w, x_ndc);
      const double estimated =
          (x * estimated_reciprocal(static_cast<double>(w), 14) * 32 + 32) * 256;
      told += std::llrint(estimated) != column * 256 + 128;
      const Expected expected =
          grid.check("w " + std::to_string(w), Buffers(kSize), [&](Frame& frame, auto&) {
            const auto one = static_cast<float>(w);
            record_draw(frame,
                        {.state = {.stencil = StencilState::both({.pass = StencilOp::incr})}},
                        {{{x, -one, 0, one},
                          {one, -one, 0, one},
                          {one, one, 0, one},
                          {x, -one, 0, one},
                          {one, one, 0, one},
                          {x, one, 0, one}}});
          });
      for (int y = 0; y < kSize.height; ++y)
        for (int px = 0; px < kSize.width; ++px)
          ASSERT_EQ(expected.only().stencil.at(px, y), px >= column) << w << ' ' << px;
    }
  EXPECT_GT(told, 100);
}
