// Lighting at vertices beside OpenGL's own (oracle: the fixed function of Mesa's llvmpipe): the
// same triangles, materials and lights, colours compared pixel by pixel. Eye space is world space.
#include <GL/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "osmesa/osmesa_context.h"
#include "random_frames.h"
#include "raster/execute.h"
#include "replay.h"

using namespace gnomon;
using namespace gnomon::raster;
using random_frames::Random;

namespace {

constexpr int kSize = 128;
/// Both round the same real colour to 8 bits, from float32 sums in another order (Mesa takes
/// reciprocal roots and powers from polynomials, and interpolates along planes): next to a half the
/// two roundings may fall to both sides. More than one step is another colour.
constexpr int kLargestDifference = 1;

struct Scene {
  std::vector<glm::vec4> positions, colors;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> indices;
  glm::mat4 projection{1.0f};
  Lit lit;
  State state;

  MeshView view() const { return {positions, indices, normals, colors}; }
};

glm::vec3 random_vec3(Random& random, float low, float high) {
  const float x = random.real(low, high), y = random.real(low, high);
  return {x, y, random.real(low, high)};
}

Light random_light(Random& random) {
  Light light;
  light.position = {random.real(-3, 3), random.real(-3, 3), random.real(-3, 1),
                    random.chance(0.6f) ? 1.0f : 0.0f};
  light.ambient = random_vec3(random, 0.0f, 0.2f);
  light.diffuse = random_vec3(random, 0.0f, 0.9f);
  light.specular = random_vec3(random, 0.0f, 0.9f);
  if (light.position.w == 0.0f) return light;
  if (random.chance(0.6f)) light.attenuation = random_vec3(random, 0.1f, 0.5f);
  if (random.chance(0.5f)) {
    light.spot_direction = glm::normalize(glm::vec3(0, 0, -4) - glm::vec3(light.position) +
                                          random_vec3(random, -0.5f, 0.5f));
    // OpenGL's widest cone that is one is a half space.
    light.spot_cos_cutoff = random.real(0.3f, 0.8f);
    light.spot_exponent = random.integer(0, 8);
  }
  return light;
}

/// A bent sheet in front of the eye, seen from both sides, that the near plane and the sides cut.
Scene random_scene(std::uint32_t seed) {
  Random random(seed);
  Scene scene;
  constexpr std::uint32_t kSide = 9;
  const glm::vec3 bend = random_vec3(random, 0.5f, 2.0f);
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const float u = static_cast<float>(x) / 4.0f - 1.0f, v = static_cast<float>(y) / 4.0f - 1.0f;
      scene.positions.emplace_back(2.0f * u, 2.0f * v,
                                   -3.0f + bend.z * std::sin(bend.x * 3.0f * u + bend.y * v), 1.0f);
      scene.normals.push_back(random_vec3(random, -0.6f, 0.6f) + glm::vec3(0, 0, 1.2f));
      scene.colors.emplace_back(random_vec3(random, 0.2f, 1.0f), random.real(0.2f, 1.0f));
    }
  for (std::uint32_t y = 0; y + 1 < kSide; ++y)
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = y * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
      for (const std::uint32_t index : {a, b, d, a, d, c}) scene.indices.push_back(index);
    }
  if (random.chance(0.5f)) scene.colors.clear();
  const float near = 1.5f, far = 10.0f;
  scene.projection = glm::mat4(0.0f);
  scene.projection[0][0] = scene.projection[1][1] = 1.5f;
  scene.projection[2][2] = (far + near) / (near - far);
  scene.projection[2][3] = -1.0f;
  scene.projection[3][2] = 2.0f * far * near / (near - far);
  Lit& lit = scene.lit;
  lit.at_vertices = true;
  lit.two_sided = random.chance(0.7f);
  lit.material = {random_vec3(random, 0, 1), random_vec3(random, 0, 1),
                  random_vec3(random, 0, 1), random_vec3(random, 0, 0.2f),
                  random.integer(0, 60),     random.real(0, 1)};
  // GL_COLOR_MATERIAL puts a vertex's colour in the material's place.
  if (!scene.colors.empty()) {
    lit.material.ambient = lit.material.diffuse = glm::vec3(1.0f);
    lit.material.alpha = 1.0f;
  }
  lit.scene_ambient = random_vec3(random, 0.0f, 0.4f);
  for (int i = random.integer(1, 4); i > 0; --i) lit.lights.push_back(random_light(random));
  scene.state.depth = DepthState{};
  if (random.chance(0.5f)) scene.state.front_face = FrontFace::cw;
  return scene;
}

void set_enabled(GLenum what, bool on) {
  if (on)
    glEnable(what);
  else
    glDisable(what);
}

void set_light(GLenum name, const Light& light) {
  const auto set = [&](GLenum what, const glm::vec3& value) {
    const glm::vec4 four(value, 1.0f);
    glLightfv(name, what, glm::value_ptr(four));
  };
  set(GL_AMBIENT, light.ambient);
  set(GL_DIFFUSE, light.diffuse);
  set(GL_SPECULAR, light.specular);
  glLightfv(name, GL_POSITION, glm::value_ptr(light.position));
  glLightf(name, GL_CONSTANT_ATTENUATION, light.attenuation.x);
  glLightf(name, GL_LINEAR_ATTENUATION, light.attenuation.y);
  glLightf(name, GL_QUADRATIC_ATTENUATION, light.attenuation.z);
  const bool spot = light.spot_cos_cutoff > -1.0f;
  constexpr float kDegrees = 57.29577951f;
  glLightfv(name, GL_SPOT_DIRECTION, glm::value_ptr(light.spot_direction));
  glLightf(name, GL_SPOT_CUTOFF, spot ? std::acos(light.spot_cos_cutoff) * kDegrees : 180.0f);
  glLightf(name, GL_SPOT_EXPONENT, static_cast<float>(light.spot_exponent));
}

void set_lighting(const Lit& lit, bool has_colors) {
  const glm::vec4 scene_ambient(lit.scene_ambient, 1.0f);
  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, glm::value_ptr(scene_ambient));
  glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, GL_TRUE);
  glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, lit.two_sided);
  // While it is on, what it tracks cannot be set.
  glDisable(GL_COLOR_MATERIAL);
  const auto set = [](GLenum what, const glm::vec3& value, float alpha) {
    const glm::vec4 four(value, alpha);
    glMaterialfv(GL_FRONT_AND_BACK, what, glm::value_ptr(four));
  };
  set(GL_AMBIENT, lit.material.ambient, 1.0f);
  set(GL_DIFFUSE, lit.material.diffuse, lit.material.alpha);
  set(GL_SPECULAR, lit.material.specular, 1.0f);
  set(GL_EMISSION, lit.material.emission, 1.0f);
  glMaterialf(GL_FRONT_AND_BACK, GL_SHININESS, static_cast<float>(lit.material.shininess));
  glColorMaterial(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE);
  set_enabled(GL_COLOR_MATERIAL, has_colors);
  for (GLenum i = 0; i < 8; ++i) set_enabled(GL_LIGHT0 + i, i < lit.lights.size());
  for (std::size_t i = 0; i < lit.lights.size(); ++i)
    set_light(GL_LIGHT0 + static_cast<GLenum>(i), lit.lights[i]);
}

void draw_by_opengl(const Scene& scene) {
  glMatrixMode(GL_PROJECTION);
  glLoadMatrixf(glm::value_ptr(scene.projection));
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
  glDisable(GL_DITHER);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_LIGHTING);
  glEnable(GL_NORMALIZE);
  glFrontFace(scene.state.front_face == FrontFace::ccw ? GL_CCW : GL_CW);
  set_lighting(scene.lit, !scene.colors.empty());
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnableClientState(GL_VERTEX_ARRAY);
  glVertexPointer(4, GL_FLOAT, 0, scene.positions.data());
  glEnableClientState(GL_NORMAL_ARRAY);
  glNormalPointer(GL_FLOAT, 0, scene.normals.data());
  if (!scene.colors.empty()) {
    glEnableClientState(GL_COLOR_ARRAY);
    glColorPointer(4, GL_FLOAT, 0, scene.colors.data());
  }
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(scene.indices.size()), GL_UNSIGNED_INT,
                 scene.indices.data());
  for (const GLenum array : {GL_VERTEX_ARRAY, GL_NORMAL_ARRAY, GL_COLOR_ARRAY})
    glDisableClientState(array);
}

struct Drawn {
  std::vector<std::uint8_t> color;
  std::vector<std::uint32_t> depth;
};

Drawn draw_by_gnomon(const Scene& scene) {
  ColorBuffer color(kSize, kSize);
  DepthBuffer depth(kSize, kSize);
  Frame frame;
  frame.begin_pass("lit", {.color = &color, .depth = &depth});
  frame.clear({.color = glm::vec4(0.0f), .depth = 1.0f});
  frame.draw({.state = scene.state,
              .mesh = scene.view(),
              .clip_from_model = scene.projection,
              .shading = scene.lit});
  execute(frame);
  return {color.to_rgba8_rows(), depth.to_rows()};
}

}  // namespace

TEST(VertexLighting, GivesTheColoursOfOpenGLsFixedFunction) {
  const peer::OsmesaContext context(kSize, kSize);
  std::size_t compared = 0, differing = 0, skipped = 0, clamped = 0;
  int largest = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    const Scene scene = random_scene(seed);
    const Drawn own = draw_by_gnomon(scene);
    draw_by_opengl(scene);
    ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    const peer::Buffers mesa = peer::read_back(context);
    for (std::size_t i = 0; i < own.depth.size(); ++i) {
      const std::uint32_t apart =
          std::max(own.depth[i], mesa.depth[i]) - std::min(own.depth[i], mesa.depth[i]);
      // Another triangle, or none, lies there: outlines and folds that snap to other sub-pixels.
      if (apart > 1u << 12) {
        ++skipped;
        continue;
      }
      for (std::size_t c = 4 * i; c < 4 * i + 4; ++c) {
        const int difference = std::abs(int{own.color[c]} - int{mesa.color[c]});
        ++compared;
        clamped += own.color[c] == 255;
        differing += difference != 0;
        largest = std::max(largest, difference);
        if (context.is_llvmpipe()) {
          ASSERT_LE(difference, kLargestDifference)
              << "seed " << seed << ", pixel (" << i % kSize << ", " << i / kSize << "), channel "
              << c % 4 << ": " << int{own.color[c]} << " and " << int{mesa.color[c]};
        }
      }
    }
  }
  std::printf(
      "%s: %zu channels compared, %zu differ by at most %d; %zu pixels of outlines left out\n",
      context.renderer().c_str(), compared, differing, largest, skipped);
  EXPECT_GT(compared, 2000000u);
  EXPECT_GT(clamped, 10000u);
  EXPECT_LT(skipped, 60u * kSize * kSize / 1000);
  if (context.is_llvmpipe()) {
    EXPECT_LT(differing, compared / 100);
  }
}
