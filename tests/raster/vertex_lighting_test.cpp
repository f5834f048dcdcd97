// Lighting at vertices: the vector kernels against plain C++, bit for bit, and what comes of it
// against closed forms. The whole path is held to the reference renderer in tests/conformance, and
// to Mesa in tests/peer.
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "isa_test.h"
#include "raster/interpolate.h"
#include "raster/lit_terms.h"
#include "raster/lit_vertices.h"

using namespace gnomon::raster;

namespace {

struct Vertices {
  std::vector<glm::vec4> positions, colors;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> indices;

  MeshView view(bool with_colors) const {
    MeshView view{.positions = positions, .indices = indices, .normals = normals};
    if (with_colors) view.colors = colors;
    return view;
  }
};

class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : random_(seed) {}

  float real(float low, float high) {
    return low + (high - low) * (static_cast<float>(random_() >> 8) / 16777216.0f);
  }
  int below(int end) { return static_cast<int>(random_() % static_cast<std::uint32_t>(end)); }
  bool chance(float share) { return real(0.0f, 1.0f) < share; }
  /// Now and then something that breaks sums and comparisons.
  float hostile(float low, float high) {
    constexpr float kWild[] = {0.0f,
                               -0.0f,
                               1e-42f,
                               3e38f,
                               -3e38f,
                               std::numeric_limits<float>::infinity(),
                               std::numeric_limits<float>::quiet_NaN()};
    return chance(0.03f) ? kWild[below(std::size(kWild))] : real(low, high);
  }
  glm::vec3 vec3(float low, float high) {
    const float x = real(low, high), y = real(low, high);
    return {x, y, real(low, high)};
  }

 private:
  std::mt19937 random_;
};

Vertices hostile_vertices(std::size_t count, Numbers& numbers) {
  Vertices out;
  for (std::size_t i = 0; i < count; ++i) {
    const auto four = [&](float low, float high) {
      glm::vec4 v;
      for (int c = 0; c < 4; ++c) v[c] = numbers.hostile(low, high);
      return v;
    };
    out.positions.push_back(four(-2.0f, 2.0f));
    out.normals.push_back(numbers.chance(0.1f) ? glm::vec3(0.0f) : glm::vec3(four(-1.0f, 1.0f)));
    out.colors.push_back(four(-0.2f, 1.5f));
  }
  return out;
}

Lit random_lit(Numbers& numbers) {
  Lit lit{.at_vertices = true};
  lit.material = {numbers.vec3(0, 1),    numbers.vec3(0, 1), glm::vec3(0.0f),
                  numbers.vec3(0, 0.3f), numbers.below(40),  numbers.real(0, 1)};
  if (numbers.chance(0.7f)) lit.material.specular = numbers.vec3(0, 1);
  for (int i = numbers.below(4); i > 0; --i) {
    Light light;
    light.position = {numbers.vec3(-3, 3), numbers.chance(0.6f) ? 1.0f : 0.0f};
    if (numbers.chance(0.3f)) light.ambient = numbers.vec3(0, 0.2f);
    light.diffuse = numbers.vec3(0, 1);
    light.specular = numbers.vec3(0, 1);
    if (numbers.chance(0.5f)) light.attenuation = numbers.vec3(0, 1);
    if (numbers.chance(0.4f)) {
      light.spot_direction = glm::normalize(numbers.vec3(-1, 1));
      light.spot_cos_cutoff = numbers.real(-0.5f, 0.9f);
      light.spot_exponent = numbers.below(6);
    }
    lit.lights.push_back(light);
  }
  lit.scene_ambient = numbers.vec3(0, 0.5f);
  for (bool* term : {&lit.ambient, &lit.emission, &lit.diffuse, &lit.specular})
    *term = numbers.chance(0.8f);
  lit.two_sided = numbers.chance(0.5f);
  lit.eye_world = numbers.vec3(-3, 3);
  for (int c = 0; c < 3; ++c) {
    lit.world_from_model[c] = glm::vec4(numbers.vec3(-1, 1), 0.0f);
    lit.world_from_model_normal[c] = numbers.vec3(-1, 1);
  }
  return lit;
}

std::array<std::uint32_t, 4> bits(const glm::vec4& v) {
  const auto of = [](float f) { return std::bit_cast<std::uint32_t>(f); };
  return {of(v.x), of(v.y), of(v.z), of(v.w)};
}

class VertexLighting : public gnomon::IsaTest {};
GNOMON_ON_EVERY_ISA(VertexLighting);

/// A triangle over the target's lower left half, the same in clip space and in the world; the
/// pixels of the diagonal, whose centres lie on its edge, are not its.
struct Corners {
  std::array<glm::vec4, 3> positions{glm::vec4{-1, -1, 0, 1}, {1, -1, 0, 1}, {-1, 1, 0, 1}};
  std::array<glm::vec3, 3> normals{glm::vec3{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  std::array<glm::vec2, 3> texcoords{};
  std::array<std::uint32_t, 3> indices{0, 1, 2};

  MeshView view() const { return {positions, indices, normals, {}, texcoords}; }
};

constexpr int kSize = 16;

/// The colours of a target that the corners were drawn to; alpha 0 where they were not.
ColorBuffer drawn(const Corners& corners, const Lit& lit, const ExecuteOptions& options,
                  const State& state = {}, ColorFormat format = ColorFormat::rgba32f) {
  ColorBuffer color(kSize, kSize, format);
  Frame frame;
  frame.begin_pass("lit", {.color = &color});
  frame.draw({.state = state, .mesh = corners.view(), .shading = lit});
  execute(frame, options);
  return color;
}

}  // namespace

TEST_P(VertexLighting, GivesEveryVertexTheColourOfPlainCode) {  // oracle: light_vertex()
  const Kernels& kernels = gnomon::raster::kernels(GetParam());
  if (!kernels.light_vertices) GTEST_SKIP() << "plain code is the oracle";
  int clamped = 0, inside = 0;
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    Numbers numbers(seed);
    const Lit lit = random_lit(numbers);
    const std::size_t count = seed % 41;
    const Vertices vertices = hostile_vertices(count, numbers);
    const bool has_colors = numbers.chance(0.5f);
    const MeshView mesh = vertices.view(has_colors);
    const LitTerms terms = make_lit(lit);
    std::vector<LitLight> lights;
    for (const Light& light : lit.lights) lights.push_back(make_light(light));
    // One more than there are, which must stay.
    const glm::vec4 untouched(-7.0f);
    std::vector<glm::vec4> front(count + 1, untouched), back(count + 1, untouched);
    const bool wants_front = seed % 5 != 0, wants_back = seed % 3 != 0;
    kernels.light_vertices(
        {&terms, lights.data(), static_cast<int>(lights.size())},
        {mesh.positions.data(), mesh.normals.data(), has_colors ? mesh.colors.data() : nullptr},
        count, wants_front ? front.data() : nullptr, wants_back ? back.data() : nullptr);
    Lit sides = lit;
    sides.two_sided = true;
    for (std::size_t i = 0; i < count; ++i) {
      Fragment vertex = vertex_attributes(mesh, lit, i);
      const glm::vec4 expected = light_vertex(sides, vertex);
      if (wants_front) {
        ASSERT_EQ(bits(front[i]), bits(expected)) << "seed " << seed << ", vertex " << i;
      }
      for (int c = 0; c < 4; ++c) ++(expected[c] > 0.0f && expected[c] < 1.0f ? inside : clamped);
      vertex.front_facing = false;
      if (wants_back) {
        ASSERT_EQ(bits(back[i]), bits(light_vertex(sides, vertex)))
            << "seed " << seed << ", vertex " << i;
      }
    }
    EXPECT_EQ(front[wants_front ? count : 0], untouched);
    EXPECT_EQ(back[wants_back ? count : 0], untouched);
  }
  EXPECT_GT(inside, 5000);
  EXPECT_GT(clamped, 1000);
}

TEST_P(VertexLighting, OfVerticesThatAreAlikeIsLightingOfFragments) {
  // Oracle: the same draw lit at fragments. Its light is at infinity, so that places do not matter;
  // what is left are the roundings of an interpolation, 2^-21 of the colour.
  Corners corners;
  corners.normals.fill({0.3f, 0.2f, 0.9f});
  Lit lit;
  lit.material = {{0.3f, 0.2f, 0.1f}, {0.5f, 0.6f, 0.7f}, glm::vec3(0.0f), {0.05f, 0, 0}, 0, 0.5f};
  lit.scene_ambient = glm::vec3(0.3f);
  lit.lights = {Light{.position = {0.5f, 0.4f, 1.0f, 0.0f}}};
  const ColorBuffer fragments = drawn(corners, lit, options());
  lit.at_vertices = true;
  const ColorBuffer vertices = drawn(corners, lit, options());
  int covered = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      covered += fragments.at(x, y).a > 0.0f;
      for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(vertices.at(x, y)[c], fragments.at(x, y)[c], 1.0 / (1 << 21));
    }
  EXPECT_EQ(covered, kSize * (kSize - 1) / 2);
}

TEST_P(VertexLighting, FollowsTheEquationAtEachCornerAndIsLinearBetweenThem) {
  // Oracle: the equation in double at the three corners (a spot with attenuation and a highlight),
  // and the plane through the three colours. The bound is some 60 roundings of float32.
  Corners corners;
  corners.normals = {glm::vec3{0, 0, 1}, {0.2f, 0, 1}, {0, 0.5f, 2}};
  Lit lit{.at_vertices = true};
  lit.material = {{0.1f, 0.2f, 0.3f}, {0.5f, 0.4f, 0.3f}, {0.3f, 0.2f, 0.1f}, {}, 5, 0.75f};
  lit.scene_ambient = glm::vec3(0.25f);
  lit.eye_world = {0, 0, 5};
  Light light{.position = {0.25f, 0.5f, 2, 1}};
  light.ambient = glm::vec3(0.125f);
  light.diffuse = {0.9f, 0.8f, 0.7f};
  light.specular = {0.5f, 0.6f, 0.7f};
  light.attenuation = {0.5f, 0.25f, 0.125f};
  light.spot_direction = {0, 0, -1};
  light.spot_cos_cutoff = 0.5f;
  light.spot_exponent = 2;
  lit.lights = {light};
  std::array<glm::dvec3, 3> color;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 p(corners.positions[i]), n = glm::normalize(glm::dvec3(corners.normals[i]));
    const glm::dvec3 to_light = glm::dvec3(light.position) - p, l = glm::normalize(to_light);
    const double d = glm::length(to_light);
    const double strength = std::pow(l.z, 2.0) / (0.5 + 0.25 * d + 0.125 * d * d);
    const glm::dvec3 h = glm::normalize(l + glm::normalize(glm::dvec3(0, 0, 5) - p));
    color[i] =
        glm::dvec3(lit.material.ambient) * (0.25 + strength * 0.125) +
        glm::dvec3(lit.material.diffuse) * glm::dvec3(light.diffuse) * (strength * glm::dot(n, l)) +
        glm::dvec3(lit.material.specular) * glm::dvec3(light.specular) *
            (strength * std::pow(glm::dot(n, h), 5.0));
  }
  const ColorBuffer got = drawn(corners, lit, options());
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x + y < kSize - 1; ++x) {
      const double u = (x + 0.5) / kSize, v = (y + 0.5) / kSize;
      const glm::dvec3 want = color[0] * (1.0 - u - v) + color[1] * u + color[2] * v;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.at(x, y)[c], want[c], 1.0 / (1 << 18));
      EXPECT_NEAR(got.at(x, y).a, 0.75, 1.0 / (1 << 21));
    }
}

TEST_P(VertexLighting, ClampsColoursBeforeTheyAreInterpolated) {  // oracle: closed form
  Corners corners;
  corners.normals = {glm::vec3{0, 0, 1}, {0, 0, 1}, {0, 0, -1}};
  Lit lit{.at_vertices = true};
  lit.material.diffuse = glm::vec3(4.0f);
  lit.material.alpha = 3.0f;
  lit.lights = {Light{}};
  const ColorBuffer got = drawn(corners, lit, options());
  for (int y = 0; y < kSize - 1; ++y) {
    EXPECT_NEAR(got.at(0, y).g, 1.0 - (y + 0.5) / kSize, 1.0 / (1 << 20));
    EXPECT_NEAR(got.at(0, y).a, 1.0, 1.0 / (1 << 21));
  }
}

TEST_P(VertexLighting, TakesTheColoursOfTheSideThatIsSeen) {  // oracle: one side lit, one dark
  const Corners corners;
  Lit lit{.at_vertices = true};
  lit.material.ambient = glm::vec3(0.0f);
  lit.material.diffuse = glm::vec3(0.5f);
  lit.lights = {Light{}};
  const auto seen = [&](bool two_sided, FrontFace front_face, Cull cull, bool turned) {
    lit.two_sided = two_sided;
    lit.lights[0].position.z = turned ? -1.0f : 1.0f;
    return drawn(corners, lit, options(), {.cull = cull, .front_face = front_face}).at(2, 3);
  };
  const auto expect = [](const glm::vec4& got, float want) {
    EXPECT_NEAR(got.r, want, 1e-6);
    EXPECT_NEAR(got.a, 1.0f, 1e-6);
  };
  for (const bool two_sided : {false, true}) {
    for (const Cull cull : {Cull::none, Cull::back}) {
      expect(seen(two_sided, FrontFace::ccw, cull, false), 0.5f);
      expect(seen(two_sided, FrontFace::ccw, cull, true), 0.0f);
    }
    for (const Cull cull : {Cull::none, Cull::front}) {
      expect(seen(two_sided, FrontFace::cw, cull, false), two_sided ? 0.0f : 0.5f);
      expect(seen(two_sided, FrontFace::cw, cull, true), two_sided ? 0.5f : 0.0f);
    }
    EXPECT_EQ(seen(two_sided, FrontFace::ccw, Cull::front_and_back, false).a, 0.0f);
  }
}

TEST_P(VertexLighting, LetsTheTextureScaleTheHighlightToo) {  // oracle: closed form
  const Corners corners;
  auto texture = std::make_shared<Texture>(Texture{1, 1, {{51, 255, 255, 255}}});
  Lit lit{.texture = texture};
  lit.material = {{}, {}, glm::vec3(1.0f), {}, 0, 1.0f};
  lit.lights = {Light{}};
  EXPECT_NEAR(drawn(corners, lit, options()).at(2, 2).r, 1.0, 1e-6);
  lit.at_vertices = true;
  EXPECT_NEAR(drawn(corners, lit, options()).at(2, 2).r, 0.2, 1e-6);
}

TEST(VertexLighting, OfALightWithAShadowMapIsMisuse) {
  const Corners corners;
  const DepthBuffer map(4, 4);
  ColorBuffer color(kSize, kSize);
  Lit lit{.at_vertices = true};
  lit.lights.resize(2);
  lit.lights[1].shadow_map = DepthLookup{.map = &map};
  Frame frame;
  frame.begin_pass("lit", {.color = &color});
  EXPECT_THROW(frame.draw({.mesh = corners.view(), .shading = lit}), std::invalid_argument);
  lit.at_vertices = false;
  EXPECT_NO_THROW(frame.draw({.mesh = corners.view(), .shading = lit}));
}

TEST(VertexLighting, NeedsNormals) {
  Corners corners;
  MeshView mesh = corners.view();
  mesh.normals = {};
  ColorBuffer color(kSize, kSize);
  Frame frame;
  frame.begin_pass("lit", {.color = &color});
  EXPECT_THROW(frame.draw({.mesh = mesh, .shading = Lit{.at_vertices = true}}),
               std::invalid_argument);
}
