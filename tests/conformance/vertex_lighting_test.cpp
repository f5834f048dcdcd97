// Lighting at vertices (OpenGL 4.6 compatibility, section 12.2), as whole draws: random meshes,
// some of them cut by planes or turned over, x lights (points, directions, spots, attenuation) x
// terms x sides x culling x vertex colours x textures x blends x colour masks, RGBA8 and RGBA32F.
// Oracle: the slow reference, which lights a fragment's three vertices again for each fragment.
#include <gtest/gtest.h>

#include <array>

#include <glm/geometric.hpp>

#include "grid.h"
#include "raster/random_frames.h"
#include "shapes.h"

using namespace gnomon::raster;
using namespace gnomon::conformance;
using gnomon::random_frames::Random;

namespace {

glm::vec3 random_vec3(Random& random, float low, float high) {
  const float x = random.real(low, high), y = random.real(low, high);
  return {x, y, random.real(low, high)};
}

/// Vertices of loose triangles: most on the target, some far off it, behind the eye or at infinity.
Triangles random_triangles(Random& random) {
  Triangles out;
  for (int i = random.integer(1, 25); i > 0; --i) {
    const glm::vec3 middle = random_vec3(random, -0.8f, 0.8f);
    const float size = random.chance(0.3f) ? 1.5f : 0.2f;
    for (int k = 0; k < 3; ++k) {
      const float w = random.chance(0.05f) ? random.real(-0.5f, 0.0f) : random.real(0.7f, 1.5f);
      out.positions.emplace_back((middle + size * random_vec3(random, -1.0f, 1.0f)) * w, w);
      if (random.chance(0.02f)) out.positions.back() *= glm::vec4(1e4f, 1e4f, 1.0f, 1.0f);
      out.normals.push_back(random.chance(0.05f) ? glm::vec3(0.0f)
                                                 : random_vec3(random, -1.0f, 1.5f));
      out.colors.emplace_back(random_vec3(random, 0.0f, 1.5f), random.real(0.0f, 1.2f));
      out.texcoords.emplace_back(random.real(-1.0f, 2.0f), random.real(-1.0f, 2.0f));
    }
  }
  if (random.chance(0.5f)) out.colors.clear();
  return out;
}

std::shared_ptr<const Texture> random_texture(Random& random) {
  auto texture = std::make_shared<Texture>(Texture{2, 2, std::vector<Rgba8>(4)});
  for (Rgba8& texel : texture->texels)
    for (std::uint8_t& channel : texel) channel = static_cast<std::uint8_t>(random.integer(0, 255));
  return texture;
}

Light random_light(Random& random) {
  Light light;
  light.position = {random_vec3(random, -2.0f, 2.0f), random.chance(0.6f) ? 1.0f : 0.0f};
  if (random.chance(0.3f)) light.ambient = random_vec3(random, 0.0f, 0.2f);
  light.diffuse = random_vec3(random, 0.0f, 1.0f);
  light.specular = random_vec3(random, 0.0f, 1.0f);
  if (random.chance(0.5f)) light.attenuation = random_vec3(random, 0.0f, 1.0f);
  if (random.chance(0.3f)) {
    light.spot_direction = glm::normalize(random_vec3(random, -1.0f, 1.0f));
    light.spot_cos_cutoff = random.real(-0.5f, 0.7f);
    light.spot_exponent = random.integer(0, 5);
  }
  return light;
}

Lit random_lit(Random& random) {
  Lit lit{.at_vertices = true};
  lit.material = {random_vec3(random, 0, 1),    random_vec3(random, 0, 1), glm::vec3(0.0f),
                  random_vec3(random, 0, 0.3f), random.integer(0, 30),     random.real(0, 1)};
  if (random.chance(0.6f)) lit.material.specular = random_vec3(random, 0, 1);
  for (int i = random.integer(0, 4); i > 0; --i) lit.lights.push_back(random_light(random));
  lit.scene_ambient = random_vec3(random, 0, 0.5f);
  for (bool* term : {&lit.ambient, &lit.emission, &lit.diffuse, &lit.specular})
    *term = random.chance(0.85f);
  lit.two_sided = random.chance(0.6f);
  lit.eye_world = random_vec3(random, -3, 3);
  lit.world_from_model[3] = {random_vec3(random, -0.5f, 0.5f), 1.0f};
  lit.world_from_model_normal[1] = random_vec3(random, -0.3f, 1.0f);
  if (random.chance(0.25f)) lit.texture = random_texture(random);
  return lit;
}

/// Two draws at vertices that share a mesh and its triangles, with one at fragments between them.
void record(Frame& frame, Buffers& buffers, std::uint32_t seed) {
  (void)buffers;
  Random random(seed);
  const Triangles triangles = random_triangles(random);
  State state{.depth = DepthState{CompareFunc::less_equal}};
  if (random.chance(0.4f)) state.cull = static_cast<Cull>(random.integer(0, 3));
  if (random.chance(0.3f)) state.front_face = FrontFace::cw;
  state.depth_clamp = random.chance(0.3f);
  for (int i = 0; i < 3; ++i) {
    Draw draw{.state = state, .shading = random_lit(random)};
    if (i == 1) std::get<Lit>(draw.shading).at_vertices = false;
    if (random.chance(0.4f))
      draw.state.color.blend =
          Blend{.src_color = BlendFactor::src_alpha, .dst_color = BlendFactor::one_minus_src_alpha};
    if (random.chance(0.2f))
      for (bool& write : draw.state.color.write) write = random.chance(0.5f);
    record_draw(frame, std::move(draw), triangles);
  }
}

}  // namespace

TEST(VertexLighting, OfRandomMeshesAndLightsEqualsTheReference) {
  Grid grid("lighting at vertices");
  std::uint64_t passed = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    const Size size = std::array<Size, 3>{{{7, 5}, {63, 65}, {130, 70}}}[seed % 3];
    const Buffers initial(size, kDepthFormats[seed / 6 % 2],
                          seed / 3 % 2 ? ColorFormat::rgba8 : ColorFormat::rgba32f);
    passed += grid.check(
                      "seed " + std::to_string(seed), initial,
                      [&](Frame& frame, Buffers& buffers) { record(frame, buffers, seed); },
                      seed % 12 < 3 ? Runs::every_variant : Runs::each_isa)
                  .outcomes.pass;
  }
  EXPECT_GT(passed, 100000u);
}
