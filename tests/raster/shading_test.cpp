// Interpolation, lighting and textures against closed forms in double. The bound, 2^-18 of the
// largest term, is some 60 roundings of float32; bytes are promised by reference_test.cpp, values
// by this file.
#include "raster/shading.h"

#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "raster/execute.h"

using namespace gnomon::raster;

namespace {

constexpr double kBound = 1.0 / (1 << 18);

Texture checker() {
  Texture texture;
  texture.width = texture.height = 2;
  texture.texels = {{0, 0, 0, 255}, {255, 0, 0, 255}, {0, 255, 0, 255}, {255, 255, 0, 255}};
  return texture;
}

}  // namespace

TEST(Shading, FollowsTheLightingEquation) {
  Lit lit;
  lit.material = {
      {0.1f, 0.2f, 0.3f}, {0.5f, 0.4f, 0.3f}, {0.6f, 0.6f, 0.6f}, {0.01f, 0.02f, 0.03f}, 5, 1.0f};
  lit.scene_ambient = glm::vec3(0.25f);
  lit.eye_world = {0.0f, 0.0f, 5.0f};
  Light light;
  light.position = {1.0f, 2.0f, 3.0f, 1.0f};
  light.attenuation = {1.0f, 0.5f, 0.25f};
  light.diffuse = {0.9f, 0.8f, 0.7f};
  light.specular = {0.5f, 0.6f, 0.7f};
  lit.lights = {light};
  Fragment fragment;
  fragment.normal = {0.0f, 0.3f, 2.0f};
  fragment.world = {0.5f, 0.25f, 0.0f};
  const glm::vec4 got = shade(lit, fragment);

  const glm::dvec3 n = glm::normalize(glm::dvec3(fragment.normal)), p(fragment.world);
  const glm::dvec3 to_light = glm::dvec3(1, 2, 3) - p;
  const double d = glm::length(to_light), att = 1.0 / (1.0 + 0.5 * d + 0.25 * d * d);
  const glm::dvec3 l = to_light / d,
                   h = glm::normalize(l + glm::normalize(glm::dvec3(0, 0, 5) - p));
  for (int c = 0; c < 3; ++c) {
    const double want =
        lit.material.emission[c] + lit.material.ambient[c] * 0.25 +
        att * lit.material.diffuse[c] * light.diffuse[c] * glm::dot(n, l) +
        att * lit.material.specular[c] * light.specular[c] * std::pow(glm::dot(n, h), 5.0);
    EXPECT_NEAR(got[c], want, kBound);
  }
}

TEST(Shading, ASurfaceTurnedAwayGetsAmbientAndEmissionOnly) {
  Lit lit;
  lit.scene_ambient = glm::vec3(0.5f);
  lit.material.specular = glm::vec3(1.0f);
  lit.lights = {Light{}};
  Fragment fragment;
  fragment.normal = {0.0f, 0.0f, -1.0f};
  EXPECT_FLOAT_EQ(shade(lit, fragment).r, 0.1f);
  lit.two_sided = true;
  fragment.front_facing = false;
  EXPECT_GT(shade(lit, fragment).r, 0.5f);
}

TEST(Shading, ASpotEndsAtItsCone) {
  Lit lit;
  lit.scene_ambient = glm::vec3(0.0f);
  Light light;
  light.position = {0.0f, 0.0f, 1.0f, 1.0f};
  light.spot_direction = {0.0f, 0.0f, -1.0f};
  light.spot_cos_cutoff = 0.8f;
  lit.lights = {light};
  Fragment fragment;
  fragment.normal = {0.0f, 0.0f, 1.0f};
  fragment.world = {0.7f, 0.0f, 0.0f};  // cosine 0.819
  EXPECT_GT(shade(lit, fragment).r, 0.0f);
  fragment.world = {0.8f, 0.0f, 0.0f};  // cosine 0.781
  EXPECT_EQ(shade(lit, fragment).r, 0.0f);
}

TEST(Shading, ASpotWiderThanAHalfSpaceTakesNoLightAway) {
  Lit lit;
  Light light;
  light.position = {0.0f, 0.0f, 1.0f, 1.0f};
  light.spot_direction = {0.0f, 0.0f, 1.0f};
  light.spot_cos_cutoff = -0.9f;
  light.spot_exponent = 1;
  lit.lights = {light};
  Fragment fragment;
  fragment.normal = {0.0f, 0.0f, 1.0f};
  fragment.world = {1.0f, 0.0f, 0.0f};  // cosine -0.707
  EXPECT_EQ(shade(lit, fragment).r, 0.0f);
}

TEST(Texture, LinearFilterMixesFourTexels) {
  Texture texture = checker();
  texture.wrap_s = texture.wrap_t = Wrap::clamp_to_edge;
  const glm::vec4 middle = sample(texture, 0.5f, 0.5f);
  EXPECT_NEAR(middle.r, 0.5, kBound);
  EXPECT_NEAR(middle.g, 0.5, kBound);
  EXPECT_EQ(sample(texture, 0.0f, 0.0f), glm::vec4(0, 0, 0, 1));
  EXPECT_NEAR(sample(texture, 0.375f, 0.25f).r, 0.25, kBound);
}

TEST(Texture, WrapModesFollowTheSpecification) {
  Texture texture = checker();
  texture.filter = Filter::nearest;
  EXPECT_EQ(sample(texture, 1.25f, 0.25f), sample(texture, 0.25f, 0.25f));
  EXPECT_EQ(sample(texture, -0.25f, 0.25f), sample(texture, 0.75f, 0.25f));
  texture.wrap_s = Wrap::clamp_to_edge;
  EXPECT_EQ(sample(texture, 7.0f, 0.25f), sample(texture, 0.75f, 0.25f));
  texture.wrap_s = Wrap::mirrored_repeat;
  EXPECT_EQ(sample(texture, 1.25f, 0.25f), sample(texture, 0.75f, 0.25f));
  EXPECT_EQ(sample(texture, std::nanf(""), 0.25f), sample(texture, 0.0f, 0.25f));
}

TEST(Interpolation, IsPerspectiveCorrectAlsoWhereThePlanesClip) {
  // Oracle: the ray's own intersection with the plane. A floor y = -1 runs from behind the eye (eye
  // at the origin, looking along -z) to z = -20; its colour's red channel is (z + 20) / 25, linear
  // in the world.
  const int width = 64, height = 64;
  ColorBuffer color(width, height, ColorFormat::rgba32f);
  const std::array<glm::vec4, 3> position{
      glm::vec4{-50, -1, 5, 1}, {50, -1, 5, 1}, {0, -1, -20, 1}};
  const std::array<glm::vec4, 3> colors{glm::vec4{1, 0, 0, 1}, {1, 0, 0, 1}, {0, 0, 0, 1}};
  const std::array<std::uint32_t, 3> indices{0, 1, 2};
  const float near = 0.125f, far = 100.0f;
  glm::mat4 projection(0.0f);
  projection[0][0] = projection[1][1] = 1.0f;
  projection[2][2] = (far + near) / (near - far);
  projection[2][3] = -1.0f;
  projection[3][2] = 2.0f * far * near / (near - far);
  Frame frame;
  frame.begin_pass("floor", {.color = &color});
  frame.draw({.mesh = {.positions = position, .indices = indices, .colors = colors},
              .clip_from_model = projection});
  execute(frame);
  int covered = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (color.at(x, y).a == 0.0f) continue;
      ++covered;
      const double slope = -((y + 0.5) / height * 2.0 - 1.0);  // the ray falls so much a metre
      const double z = -1.0 / slope;
      // A vertex snaps by 1/512 pixel at most: 2^-14 of the picture's half height in slope.
      const double bound = 1e-5 + std::abs(z * z) / 25.0 / 16384.0;
      EXPECT_NEAR(color.at(x, y).r, (z + 20.0) / 25.0, bound) << x << ' ' << y;
    }
  EXPECT_GT(covered, 400);
}
