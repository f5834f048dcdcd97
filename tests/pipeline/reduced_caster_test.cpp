// Objects in whose place another mesh casts (Object::shadow_model), by every method. Oracles: rays
// (Embree, robust mode) whose casters are those meshes; the plain method with both caps; and the
// same scene without shadow models, where the two meshes are equal.
#include <array>
#include <cstdio>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "pipeline/displaced_caster.h"
#include "pipeline/general_method.h"
#include "pipeline/haller.h"
#include "pipeline/modulative_method.h"
#include "raster/execute.h"
#include "raster/frame_format.h"
#include "tests/pipeline/stencil_check.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kScenes = 60, kWidth = 240, kHeight = 180;

using ModelPointer = std::shared_ptr<const Model>;

/// What is drawn, and what casts.
struct Pair {
  ModelPointer drawn, caster;
};

/// The caster lies within what is drawn, sticks out of it, crosses it, or coincides with it in
/// other vertices.
std::vector<Pair> closed_pairs() {
  const auto ball = [](float radius, int levels) {
    return test::model_of(test::icosphere_mesh(radius, levels));
  };
  const auto box = [](float half) { return test::model_of(test::box_mesh(glm::vec3(half))); };
  return {{ball(0.5f, 3), ball(0.5f, 0)},
          {ball(0.4f, 2), box(0.45f)},
          {ball(0.5f, 2), box(0.4f)},
          {test::model_of(test::torus_mesh(0.5f, 0.2f, 24, 12)),
           test::model_of(test::torus_mesh(0.5f, 0.2f, 8, 5))},
          {test::model_of(test::flat_box_mesh(glm::vec3(0.5f))), box(0.5f)}};
}

/// The caster is open, or what is drawn is.
std::vector<Pair> open_pairs(std::mt19937& random) {
  Mesh open_box = test::box_mesh(glm::vec3(0.45f));
  open_box.indices.resize(30);
  const ModelPointer ball = test::model_of(test::icosphere_mesh(0.5f, 2));
  return {{ball, test::model_of(test::square_mesh(0.5f))},
          {ball, test::model_of(open_box)},
          {test::model_of(test::square_mesh(0.6f)), test::model_of(test::square_mesh(0.3f))},
          {test::model_of(test::soup(random)), test::model_of(test::soup(random))},
          {test::model_of(open_box), test::model_of(test::box_mesh(glm::vec3(0.4f)))}};
}

/// Turned, scaled and mirrored bodies over a plate; every fourth casts as it is drawn.
Scene reduced_scene(int number, std::mt19937& random) {
  Scene scene = test::random_scene(random);
  const std::vector<Pair> pairs = number % 3 == 2 ? open_pairs(random) : closed_pairs();
  for (std::size_t i = 1; i < scene.objects.size(); ++i) {
    const Pair& pair = pairs[test::below(random, pairs.size())];
    scene.objects[i].model = pair.drawn;
    if (test::below(random, 4) != 0) scene.objects[i].shadow_model = pair.caster;
    // Some of the casters are moved from the light, by as much as such a pair may differ.
    if (number % 2 == 1) scene.objects[i].shadow_displace = test::uniform(random, 0.0f, 0.1f);
  }
  return scene;
}

/// Rays to what casts where the scene's light has it.
RayReference rays_to_casters(const Scene& scene) {
  return RayReference(displace_casters(scene, scene.lights[0].position));
}

Extrusion extrusion_of(int scene) {
  switch (scene / 3 % 3) {
    case 0:
      return {.kind = Extrusion::Kind::automatic};
    case 1:
      return {.kind = Extrusion::Kind::infinite};
    default:
      return {.kind = Extrusion::Kind::radius, .radius_m = 25.0f};
  }
}

Camera camera_at(const glm::vec3& eye, std::mt19937& random) {
  return test::look(eye, test::uniform_point(random, -1.5f, 1.5f), kWidth, kHeight);
}

/// Every other time in a caster's shadow.
Camera camera_anywhere(int number, const Scene& scene, const RayReference& rays,
                       std::mt19937& random) {
  for (int tries = 0;; ++tries) {
    glm::vec3 eye = test::uniform_point(random, -3.0f, 3.0f);
    eye.y = test::uniform(random, 0.1f, 3.0f);
    const bool wanted = number % 2 == 1 || rays.blocked(glm::dvec3(eye), scene.lights[0].position);
    if (wanted || tries == 1000) return camera_at(eye, random);
  }
}

/// Where z-pass counts right: no caster's volume touches the near region.
Camera camera_outside(const Scene& scene, std::mt19937& random) {
  for (;;) {
    glm::vec3 eye = test::uniform_point(random, -6.0f, 6.0f);
    eye.y = test::uniform(random, 0.5f, 5.0f);
    const Camera camera = camera_at(eye, random);
    const auto region = near_region(camera.clip_from_world);
    bool safe = region.has_value();
    for (const Object& object : scene.objects)
      safe = safe && !volume_may_touch(*region, scene.lights[0].position,
                                       build_topology(*object.caster()), object.world_from_model);
    if (safe) return camera;
  }
}

struct Sum {
  test::Disagreement rays;
  std::size_t shadowed = 0;
};

void add(Sum& sum, const test::Counted& counted, const Scene& scene, const RayReference& rays,
         const Camera& camera) {
  for (const std::uint8_t value : counted.stencil.to_rows()) sum.shadowed += value != 0;
  sum.rays += test::compare_with_rays(counted, scene, rays, camera);
}

void expect_rays(const char* what, const Sum& sum) {
  std::printf(
      "%s: %zu pixels (%zu in shadow), %zu wrong: %zu at edges, %zu ties, %zu unexplained\n", what,
      sum.rays.tested, sum.shadowed, sum.rays.wrong, sum.rays.at_edge, sum.rays.depth_tie,
      sum.rays.unexplained);
  EXPECT_EQ(sum.rays.unexplained, 0u);
  EXPECT_LT(sum.rays.wrong, sum.rays.tested / 500);
  EXPECT_GT(sum.shadowed, sum.rays.tested / 50);
}

TEST(ReducedCaster, ZPassIsTheRaysToTheCaster) {
  std::mt19937 random(31);
  Sum sum;
  for (int i = 0; i < kScenes; ++i) {
    const Scene scene = reduced_scene(i, random);
    const Camera camera = camera_outside(scene, random);
    const VolumeOptions options{VolumeMethod::zpass, extrusion_of(i)};
    // As the methods count: front caps that were drawn are left out.
    add(sum, test::count_scene(scene, camera, options, {.casters_drawn = true}), scene,
        rays_to_casters(scene), camera);
  }
  expect_rays("z-pass", sum);
}

TEST(ReducedCaster, ZFailIsTheRaysToTheCasterAlsoInsideItsVolume) {
  std::mt19937 random(32);
  Sum sum;
  std::size_t inside = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Scene scene = reduced_scene(i, random);
    const RayReference rays = rays_to_casters(scene);
    const Camera camera = camera_anywhere(i, scene, rays, random);
    inside += rays.blocked(glm::dvec3(camera.eye_world), scene.lights[0].position);
    add(sum, test::count_scene(scene, camera, {VolumeMethod::zfail, extrusion_of(i)}), scene, rays,
        camera);
  }
  expect_rays("z-fail", sum);
  EXPECT_GT(inside, kScenes / 3u);
}

TEST(ReducedCaster, TheAutomaticChoiceIsTheRaysToTheCaster) {
  std::mt19937 random(33);
  Sum sum;
  std::size_t zpass = 0, zfail = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Scene scene = reduced_scene(i, random);
    const RayReference rays = rays_to_casters(scene);
    const Camera camera = camera_anywhere(i, scene, rays, random);
    VolumeOptions options{VolumeMethod::automatic, extrusion_of(i)};
    if (i % 2 == 0) {
      options.counts = Counts::at_receivers;
      options.view = View{camera.clip_from_world, kWidth, kHeight};
    }
    const test::Counted counted =
        test::count_scene(scene, camera, options, {.casters_drawn = true});
    zpass += counted.zpass;
    zfail += counted.zfail;
    add(sum, counted, scene, rays, camera);
  }
  expect_rays("automatic", sum);
  EXPECT_GT(zpass, 20u);
  EXPECT_GT(zfail, 20u);
}

// Oracle: the plain method, both caps to infinity and counted everywhere, at every pixel that shows
// a surface.
TEST(ReducedCaster, WhatIsLeftOutOfVolumesChangesNoCountAtASurface) {
  std::mt19937 random(34);
  std::size_t shadowed = 0;
  for (int i = 0; i < 150; ++i) {
    const Scene scene = reduced_scene(i, random);
    const Camera camera = i % 2 ? camera_outside(scene, random)
                                : camera_anywhere(1, scene, RayReference(scene), random);
    const VolumeMethod method = i % 2 ? VolumeMethod::zpass : VolumeMethod::automatic;
    VolumeOptions lean{.method = method, .extrusion = {.kind = Extrusion::Kind::infinite}};
    if (i % 4 > 1) {
      lean.counts = Counts::at_receivers;
      lean.view = View{camera.clip_from_world, kWidth, kHeight};
    }
    const VolumeOptions plain{
        .method = method, .extrusion = {.kind = Extrusion::Kind::infinite}, .all_caps = true};
    const auto a = test::count_scene(scene, camera, lean, {.casters_drawn = true});
    const auto b = test::count_scene(scene, camera, plain);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        if (b.depth.at(x, y) == b.depth.max_value()) continue;
        shadowed += b.stencil.at(x, y) != 0;
        ASSERT_EQ(a.stencil.at(x, y), b.stencil.at(x, y)) << "scene " << i;
      }
    }
  }
  EXPECT_GT(shadowed, 100000u);
}

// Oracle: the silhouettes' volumes, byte for byte (their own proof leaves out triangle soups).
TEST(ReducedCaster, DegenerateQuadsCountWhatSilhouettesDo) {
  std::mt19937 random(35);
  VolumeMemory memory;
  std::size_t counted = 0;
  for (int i = 0; i < kScenes; ++i) {
    const Scene scene = reduced_scene(i % 2, random);
    const Camera camera = camera_anywhere(i, scene, RayReference(scene), random);
    VolumeOptions options{.method = i % 2 ? VolumeMethod::zpass : VolumeMethod::zfail,
                          .extrusion = {.kind = Extrusion::Kind::infinite},
                          .all_caps = true,
                          .memory = &memory};
    const auto expected = test::count_scene(scene, camera, options).stencil.to_rows();
    options.geometry = VolumeGeometry::degenerate_quads;
    ASSERT_EQ(test::count_scene(scene, camera, options).stencil.to_rows(), expected) << i;
    for (const std::uint8_t value : expected) counted += value != 0;
  }
  EXPECT_GT(counted, 100000u);
}

TEST(ReducedCaster, AliasFreeMapsAreTheRaysToTheCaster) {
  std::mt19937 random(36);
  Sum sum;
  AliasFreeMemory memory;
  for (int i = 0; i < kScenes; ++i) {
    const Scene scene = reduced_scene(i, random);
    const RayReference rays = rays_to_casters(scene);
    const Camera camera = camera_anywhere(i, scene, rays, random);
    TopologyCache topologies;
    const std::vector<PlacedObject> objects = place_objects(scene, camera, topologies);
    memory.finder.find(objects, camera, kWidth, kHeight, raster::DepthFormat::d24, 0);
    const auto hidden = find_hidden(objects, Casters(scene), camera, scene.lights[0], 0, memory);
    // For its depth.
    test::Counted drawn = test::count_scene(scene, camera, {});
    raster::Frame frame;
    frame.begin_pass("mask", {.stencil = &drawn.stencil});
    frame.clear({.stencil = 0});
    stencil_hidden(frame, hidden, kWidth, kHeight, "hidden");
    raster::execute(frame);
    add(sum, drawn, scene, rays, camera);
  }
  expect_rays("alias-free", sum);
}

struct Picture {
  raster::ColorBuffer color{kWidth, kHeight, raster::ColorFormat::rgba32f};
  raster::DepthBuffer depth{kWidth, kHeight};
  raster::StencilBuffer stencil{kWidth, kHeight};
  raster::Targets targets() { return {&color, &depth, &stencil}; }
  std::size_t different_from(const Picture& other) const {
    std::size_t count = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) count += color.at(x, y) != other.color.at(x, y);
    return count;
  }
  bool operator==(const Picture& other) const {
    return different_from(other) == 0 && depth.to_rows() == other.depth.to_rows() &&
           stencil.to_rows() == other.stencil.to_rows();
  }
};

Picture general(Scene scene, const Camera& camera, ShadowMethod method, GeneralOptions options = {},
                const MapSettings& settings = {}) {
  for (Light& light : scene.lights) {
    light.shadow = method;
    light.map = settings;
  }
  Picture picture;
  MapMemory maps;
  options.maps = &maps;
  raster::execute(record_general(scene, camera, picture.targets(), options));
  return picture;
}

/// Pixels that the light reaches or would reach, and those of them that are dark for the rays and
/// not in the picture or the other way.
struct MapSum {
  std::size_t tested = 0, dark = 0, wrong = 0;
};

void compare_map(MapSum& sum, const Scene& scene, const Camera& camera,
                 const MapSettings& settings) {
  Scene unlit = scene;
  unlit.lights[0].color = glm::vec3(0.0f);
  const Picture ambient = general(unlit, camera, ShadowMethod::none);
  const Picture lit = general(scene, camera, ShadowMethod::none);
  const Picture mapped = general(scene, camera, ShadowMethod::map, {}, settings);
  const auto samples = rays_to_casters(scene).cast(pixel_rays(camera), scene.lights[0].position);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto& sample = samples[static_cast<std::size_t>(y * kWidth + x)];
      if (!sample.hit.hit || sample.shadow.faces_away) continue;
      if (lit.color.at(x, y) == ambient.color.at(x, y)) continue;
      const bool is_dark = mapped.color.at(x, y) != lit.color.at(x, y);
      ++sum.tested;
      sum.dark += is_dark;
      sum.wrong += is_dark != sample.shadow.in_shadow;
    }
  }
}

// A map of finite size is wrong along shadows' edges, by its texels' share of the picture. Closed
// casters only, and cameras above them: what is in a body, a map of its averted faces does not
// know. Where the drawn surface lies in its caster, the map holds faces behind it and lights it.
TEST(ReducedCaster, MapsDifferFromTheRaysToTheCasterAlongEdges) {
  std::mt19937 random(37);
  MapSum sum;
  for (int i = 0; i < kScenes; ++i) {
    Scene scene = reduced_scene(0, random);
    const std::vector<Pair> pairs = closed_pairs();
    // Casters within what is drawn, or equal to it.
    for (std::size_t o = 1; o < scene.objects.size(); ++o) {
      const Pair& pair = pairs[(o + static_cast<std::size_t>(i)) % 2 * 4];
      scene.objects[o].model = pair.drawn;
      scene.objects[o].shadow_model = pair.caster;
      if (i % 2 == 1) scene.objects[o].shadow_displace = 0.02f;
    }
    glm::vec3 eye = test::uniform_point(random, -4.0f, 4.0f);
    eye.y = 3.5f;
    compare_map(sum, scene, camera_at(eye, random), {});
  }
  std::printf("maps: %zu pixels, %zu dark, %zu wrong\n", sum.tested, sum.dark, sum.wrong);
  EXPECT_LT(sum.wrong, sum.tested / 100);
  EXPECT_GT(sum.dark, sum.tested / 50);
}

TEST(ReducedCaster, SixMapsDifferFromTheRaysToTheCasterAlongEdges) {
  std::mt19937 random(38);
  const std::vector<Pair> pairs = closed_pairs();
  MapSum sum;
  for (int i = 0; i < 20; ++i) {
    Scene scene;
    scene.objects.push_back(
        {.name = "room", .model = test::model_of(test::box_mesh(glm::vec3(3.0f))), .casts = false});
    // Drawn from within, where its normals must face.
    Mesh room = test::flat_box_mesh(glm::vec3(3.0f));
    for (std::size_t k = 0; k < room.indices.size(); k += 3)
      std::swap(room.indices[k], room.indices[k + 1]);
    for (glm::vec3& normal : room.normals) normal = -normal;
    scene.objects[0].model = test::model_of(room);
    for (int body = 0; body < 8; ++body) {
      const Pair& pair = pairs[body % 2 ? 0 : 4];
      const glm::vec3 way = glm::normalize(test::uniform_point(random, -1.0f, 1.0f));
      scene.objects.push_back(
          {.name = "body",
           .model = pair.drawn,
           .world_from_model = test::placed(way * 1.6f, way, 1.0f, glm::vec3(0.6f)),
           .shadow_model = pair.caster});
    }
    scene.lights.push_back({.name = "lamp", .position = {0.1f, 0.2f, -0.1f, 1.0f}});
    const glm::vec3 eye = 2.8f * glm::normalize(test::uniform_point(random, -1.0f, 1.0f));
    compare_map(sum, scene, camera_at(eye, random), {.sides = MapSides::six});
  }
  std::printf("six maps: %zu pixels, %zu dark, %zu wrong\n", sum.tested, sum.dark, sum.wrong);
  EXPECT_LT(sum.wrong, sum.tested / 100);
  EXPECT_GT(sum.dark, sum.tested / 20);
}

/// Equal meshes of their own memory, or the very same, which no move can part from what is drawn.
Scene with_equal_casters(Scene scene, bool copies) {
  for (Object& object : scene.objects) {
    object.shadow_model = copies ? std::make_shared<const Model>(*object.model) : object.model;
    object.shadow_displace = copies ? 0.0f : 0.1f;
  }
  return scene;
}

// Oracle: the scene without shadow models, to the byte of colour, depth and stencil. An alias-free
// map knows a surface's own side without a test only where the surface casts itself, so there a
// copy may differ in pixels that a snapped edge covers.
TEST(ReducedCaster, EqualToWhatIsDrawnLeavesThePictureAsItWas) {
  std::mt19937 random(39);
  std::size_t alias_free_different = 0;
  for (int i = 0; i < 30; ++i) {
    Scene plain = reduced_scene(i, random);
    for (Object& object : plain.objects) object.shadow_model = nullptr;
    const Camera camera = camera_anywhere(i, plain, RayReference(plain), random);
    for (const bool copies : {false, true}) {
      const Scene scene = with_equal_casters(plain, copies);
      for (const VolumeMethod method :
           {VolumeMethod::zpass, VolumeMethod::zfail, VolumeMethod::automatic}) {
        for (const VolumeGeometry geometry :
             {VolumeGeometry::silhouettes, VolumeGeometry::degenerate_quads}) {
          const GeneralOptions options{.method = method, .geometry = geometry};
          ASSERT_TRUE(general(scene, camera, ShadowMethod::volumes, options) ==
                      general(plain, camera, ShadowMethod::volumes, options))
              << "scene " << i << ", copies " << copies;
        }
        const ModulativeOptions options{.method = method};
        Picture a, b;
        raster::execute(record_modulative(plain, camera, a.targets(), options));
        raster::execute(record_modulative(scene, camera, b.targets(), options));
        ASSERT_TRUE(a == b) << "modulative, scene " << i << ", copies " << copies;
      }
      ASSERT_TRUE(general(scene, camera, ShadowMethod::map) ==
                  general(plain, camera, ShadowMethod::map))
          << "scene " << i << ", copies " << copies;
      const Picture mask = general(scene, camera, ShadowMethod::alias_free);
      const Picture plain_mask = general(plain, camera, ShadowMethod::alias_free);
      if (!copies) {
        ASSERT_TRUE(mask == plain_mask) << "scene " << i;
      }
      alias_free_different += mask.different_from(plain_mask);
    }
  }
  std::printf("alias-free maps of copies: %zu pixels differ\n", alias_free_different);
  EXPECT_LT(alias_free_different, 30u * kWidth * kHeight / 10000u);
}

struct Augmented {
  Picture picture;
  raster::ColorBuffer masks{kWidth, kHeight};
};

Augmented haller(const Scene& scene, const Camera& camera, HallerOptions options) {
  Augmented out;
  const std::vector<std::uint8_t> photograph(std::size_t{3} * kWidth * kHeight, 200);
  options.masks = &out.masks;
  raster::execute(record_haller(
      scene, camera, raster::ImageView::from_top_row(photograph.data(), kWidth, kHeight, 3),
      out.picture.targets(), options));
  return out;
}

// Oracles: the scene without shadow models where they are equal to what is drawn; the same method
// with both caps; and rays, for virtual shadows on real surfaces.
TEST(ReducedCaster, CastsInHallersMethod) {
  std::mt19937 random(40);
  std::size_t tested = 0, shadowed = 0, wrong = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene scene = reduced_scene(i, random);
    const RayReference rays = rays_to_casters(scene);
    const Camera camera = camera_anywhere(i, scene, rays, random);
    HallerOptions options{.extrusion = {.kind = Extrusion::Kind::infinite}};
    const Augmented lean = haller(scene, camera, options);
    options.all_caps = true;
    ASSERT_TRUE(lean.picture == haller(scene, camera, options).picture) << "caps, scene " << i;
    Scene plain = scene;
    for (Object& object : plain.objects) object.shadow_model = nullptr;
    ASSERT_TRUE(haller(with_equal_casters(plain, true), camera, {}).picture ==
                haller(plain, camera, {}).picture)
        << "equal, scene " << i;
    const auto bytes = lean.masks.to_rgba8_rows();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const RayHit hit = rays.trace(window_ray(camera, x + 0.5, y + 0.5));
        const std::uint8_t* mask = &bytes[static_cast<std::size_t>(4 * (y * kWidth + x))];
        if (!hit.hit || scene.objects[hit.object].role != Role::phantom || mask[2] != 0) continue;
        const glm::vec4 light = scene.lights[0].position;
        const bool expected = rays.shadow(hit, light, Among::virtual_objects).in_shadow &&
                              !rays.shadow(hit, light, Among::phantoms).in_shadow;
        ++tested;
        shadowed += expected;
        wrong += expected != (mask[0] != 0);
      }
    }
  }
  std::printf("Haller: %zu pixels, %zu in virtual shadow, %zu wrong\n", tested, shadowed, wrong);
  EXPECT_GT(shadowed, tested / 100);
  EXPECT_LT(wrong, tested / 500);
}

// Closed form: straight above a plate, a lamp at twice its sheet's height doubles it; what is drawn
// there is a ball that has no say in the shadow.
TEST(ReducedCaster, ThrowsItsOwnShadowAndNotThatOfWhatIsDrawn) {
  Scene scene;
  scene.objects = {{.name = "plate", .model = test::model_of(test::square_mesh(3.0f))},
                   {.name = "ball",
                    .model = test::model_of(test::icosphere_mesh(0.8f, 3)),
                    .world_from_model = test::placed({0.0f, 2.0f, 0.0f}),
                    .shadow_model = test::model_of(test::square_mesh(0.25f))}};
  const glm::vec4 light(0.0f, 4.0f, 0.0f, 1.0f);
  const RayReference rays(scene);
  for (const double x : {-0.51, -0.49, 0.0, 0.49, 0.51}) {
    const RayHit hit = rays.trace({{x, 0.5, 0.0}, {0.0, -1.0, 0.0}});
    ASSERT_EQ(hit.object, 0u);
    EXPECT_EQ(rays.shadow(hit, light).in_shadow, std::abs(x) < 0.5) << x;
  }
  // The ball's upper side is over the sheet, its lower side under it or beside it.
  EXPECT_FALSE(rays.shadow(rays.trace({{0.1, 3.5, 0.1}, {0.0, -1.0, 0.0}}), light).in_shadow);
  EXPECT_TRUE(rays.shadow(rays.trace({{0.1, 0.5, 0.1}, {0.0, 1.0, 0.0}}), light).in_shadow);
  EXPECT_FALSE(rays.shadow(rays.trace({{0.7, 0.5, 0.1}, {0.0, 1.0, 0.0}}), light).in_shadow);
}

// Closed form: a sphere's lit side sticks out of no coarser sphere about it that is moved from the
// light by more than the two differ along the light; the plate's shadow keeps its bytes, for a
// direction's rays meet the same outline.
TEST(ReducedCaster, MovedFromTheLightLeavesTheLitSideLitAndTheShadowWhereItWas) {
  Scene scene;
  scene.objects = {
      {.name = "plate", .model = test::model_of(test::square_mesh(3.0f)), .casts = false},
      {.name = "ball",
       .model = test::model_of(test::icosphere_mesh(0.5f, 3)),
       .world_from_model = test::placed({0.0f, 1.5f, 0.0f}),
       .shadow_model = test::model_of(test::icosphere_mesh(0.52f, 2))}};
  for (const glm::vec4& light :
       {glm::vec4(0.3f, 0.9f, 0.2f, 0.0f), glm::vec4(1.5f, 5.0f, 1.0f, 1.0f)}) {
    scene.lights = {{.name = "light", .position = light}};
    const Camera camera = test::look({1.0f, 4.0f, 3.0f}, {0.0f, 0.7f, 0.0f}, kWidth, kHeight);
    const RayReference rays(scene);
    std::array<std::array<std::size_t, 2>, 2>
        dark{};  // At rest and moved: the lit side, the plate.
    for (const bool moved : {false, true}) {
      scene.objects[1].shadow_displace = moved ? 0.06f : 0.0f;
      const auto counted = test::count_scene(scene, camera, {}, {.casters_drawn = true});
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const RayHit hit = rays.trace(window_ray(camera, x + 0.5, y + 0.5));
          if (!hit.hit || counted.stencil.at(x, y) == 0) continue;
          const glm::dvec3 towards =
              glm::normalize(light.w == 0.0f ? glm::dvec3(light) : glm::dvec3(light) - hit.point);
          if (hit.object == 0 || glm::dot(hit.normal, towards) > 0.6)
            ++dark[moved][hit.object == 0];
        }
      }
    }
    EXPECT_GT(dark[0][0], 500u);
    EXPECT_EQ(dark[1][0], 0u);
    EXPECT_GT(dark[1][1], 500u);
    // Snapped corners that have moved along their rays round elsewhere.
    EXPECT_NEAR(static_cast<double>(dark[1][1]), static_cast<double>(dark[0][1]), 10.0);
  }
}

// Oracle: the frame that was recorded.
TEST(ReducedCaster, ComesBackFromASavedFrame) {
  std::mt19937 random(41);
  const Scene scene = reduced_scene(0, random);
  const Camera camera = camera_anywhere(0, scene, RayReference(scene), random);
  for (const ShadowMethod method : {ShadowMethod::volumes, ShadowMethod::map}) {
    Scene lit = scene;
    lit.lights[0].shadow = method;
    MapMemory maps;
    Picture picture;
    const raster::Frame frame = record_general(lit, camera, picture.targets(),
                                               {.method = VolumeMethod::zpass, .maps = &maps});
    const std::vector<std::uint8_t> bytes = raster::encode_frame(frame);
    EXPECT_EQ(raster::encode_frame(raster::decode_frame(bytes).frame), bytes);
  }
}

TEST(ReducedCaster, WithoutATriangleCastsNothing) {
  std::mt19937 random(42);
  Scene scene = test::random_scene(random);
  for (Object& object : scene.objects) object.shadow_model = test::model_of(Mesh{});
  const Camera camera = camera_anywhere(1, scene, RayReference(scene), random);
  const Picture lit = general(scene, camera, ShadowMethod::none);
  for (const ShadowMethod method :
       {ShadowMethod::volumes, ShadowMethod::map, ShadowMethod::alias_free}) {
    const Picture drawn = general(scene, camera, method);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) ASSERT_EQ(drawn.color.at(x, y), lit.color.at(x, y));
  }
}

}  // namespace
}  // namespace gnomon::pipeline
