#include "pipeline/haller.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/light_samples.h"
#include "pipeline/passes.h"
#include "pipeline/ray_reference.h"
#include "raster/execute.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

using ::testing::ElementsAre;

constexpr int kWidth = 320, kHeight = 240;

/// A photograph of noise between 60 and 250, so that darkening always shows.
std::vector<std::uint8_t> noise_photograph() {
  std::mt19937 random(5);
  std::vector<std::uint8_t> bytes(3 * kWidth * kHeight);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(60 + test::below(random, 191));
  }
  return bytes;
}

struct Buffers {
  raster::ColorBuffer color;
  raster::DepthBuffer depth{kWidth, kHeight};
  raster::StencilBuffer stencil{kWidth, kHeight};
  raster::ColorBuffer masks{kWidth, kHeight};
  std::vector<std::uint8_t> photograph = noise_photograph();

  explicit Buffers(raster::ColorFormat format = raster::ColorFormat::rgba8)
      : color(kWidth, kHeight, format) {}
  raster::Targets targets() { return {&color, &depth, &stencil}; }
  raster::ImageView view() const {
    return raster::ImageView::from_top_row(photograph.data(), kWidth, kHeight, 3);
  }
  raster::Frame record(const Scene& scene, const Camera& camera, const HallerOptions& options) {
    return record_haller(scene, camera, view(), targets(), options);
  }
  void draw(const Scene& scene, const Camera& camera, const HallerOptions& options,
            int threads = 0) {
    raster::execute(record(scene, camera, options), {.threads = threads});
  }
};

struct Shot {
  Scene scene;
  Camera camera;
};

Shot random_shot(std::mt19937& random) {
  Shot shot{test::random_scene(random), {}};
  glm::vec3 eye = test::uniform_point(random, -6.0f, 6.0f);
  eye.y = test::uniform(random, 0.5f, 5.0f);
  shot.camera = test::look(eye, test::uniform_point(random, -1.0f, 1.0f), kWidth, kHeight);
  return shot;
}

std::vector<Light> three_lights(const Light& light) {
  std::vector<Light> lights(3, light);
  for (std::size_t i = 0; i < 3; ++i) {
    lights[i].name = std::string(1, static_cast<char>('a' + i));
    lights[i].share = light.share / 3.0f;
    lights[i].color = light.color / 3.0f;
  }
  return lights;
}

std::vector<std::string> labels(const raster::Frame& frame) {
  std::vector<std::string> result;
  for (const raster::Pass& pass : frame.passes()) result.push_back(pass.label);
  return result;
}

std::vector<raster::Draw> draws_of(const raster::Frame& frame, std::string_view label) {
  std::vector<raster::Draw> draws;
  for (const raster::Pass& pass : frame.passes()) {
    if (pass.label != label) continue;
    for (const raster::Command& command : pass.commands) {
      if (const auto* draw = std::get_if<raster::Draw>(&command)) draws.push_back(*draw);
    }
  }
  return draws;
}

Shot small_shot() {
  Shot shot;
  shot.scene.objects = {{.name = "table",
                         .role = Role::phantom,
                         .model = test::model_of(test::box_mesh({3, 0.1f, 3}))},
                        {.name = "torus",
                         .model = test::model_of(test::torus_mesh(0.5f, 0.2f, 24, 12)),
                         .world_from_model = test::placed({0, 1, 0})}};
  shot.scene.lights = {{.name = "bulb", .position = {0.5f, 4, 0.5f, 1}, .share = 0.5f}};
  shot.camera = test::look({2, 3, 4}, {0, 0.3f, 0}, kWidth, kHeight);
  return shot;
}

TEST(Haller, PassesOfOneLightAreThePapersSteps) {
  const Shot shot = small_shot();
  Buffers buffers;
  EXPECT_THAT(labels(buffers.record(shot.scene, shot.camera, {})),
              ElementsAre(haller_label::kReal, haller_label::kPhantoms, haller_label::kRealVolumes,
                          haller_label::kVirtualVolumes, haller_label::kShadowOnReal,
                          haller_label::kVirtualLit, haller_label::kAllVolumes,
                          haller_label::kShadowOnVirtual));
  EXPECT_THAT(
      labels(buffers.record(shot.scene, shot.camera, {.double_shadows = true})),
      ElementsAre(haller_label::kReal, haller_label::kPhantoms, haller_label::kVirtualVolumes,
                  haller_label::kShadowOnReal, haller_label::kVirtualLit, haller_label::kAllVolumes,
                  haller_label::kShadowOnVirtual));
}

TEST(Haller, PassesOfSeveralLightsNameTheirLight) {
  Shot shot = small_shot();
  shot.scene.lights = three_lights(shot.scene.lights[0]);
  Buffers buffers;
  const raster::Frame frame = buffers.record(shot.scene, shot.camera, {.double_shadows = true});
  const std::vector<std::string> names = labels(frame);
  ASSERT_EQ(names.size(), 2u + 3 * 2 + 1 + 3 * 2);
  EXPECT_EQ(names[2], std::string(haller_label::kVirtualVolumes) + ": a");
  EXPECT_EQ(names.back(), std::string(haller_label::kShadowOnVirtual) + ": c");
  EXPECT_EQ(commands_through(frame, haller_label::kShadowOnVirtual), frame.command_count());
  EXPECT_LT(commands_through(frame, haller_label::kShadowOnReal),
            commands_through(frame, haller_label::kVirtualLit));
  EXPECT_FALSE(commands_through(frame, "step 4"));
}

TEST(Haller, PhantomsWriteDepthOnlyAndVolumesNothingButTheStencil) {
  const Shot shot = small_shot();
  Buffers buffers;
  const raster::Frame frame = buffers.record(shot.scene, shot.camera, {});
  for (const raster::Draw& draw : draws_of(frame, haller_label::kPhantoms)) {
    EXPECT_EQ(draw.label, "table");
    EXPECT_EQ(draw.state.color, raster::ColorState::off());
    EXPECT_EQ(draw.state.depth, raster::DepthState{});
  }
  const std::vector<raster::Draw> volumes = draws_of(frame, haller_label::kAllVolumes);
  ASSERT_EQ(volumes.size(), 2u);
  for (const raster::Draw& draw : volumes) {
    EXPECT_EQ(draw.state.color, raster::ColorState::off());
    EXPECT_EQ(draw.state.depth,
              (raster::DepthState{.func = raster::CompareFunc::less, .write = false}));
    EXPECT_EQ(draw.state.stencil->front.pass, raster::StencilOp::incr_wrap);
    EXPECT_EQ(draw.state.stencil->back.pass, raster::StencilOp::decr_wrap);
  }
}

TEST(Haller, AppendixLetterCountsAllFrontFacesBeforeAllBackFaces) {
  const Shot shot = small_shot();
  Buffers buffers;
  const raster::Frame frame = buffers.record(
      shot.scene, shot.camera, {.method = VolumeMethod::zpass, .appendix_letter = true});
  const std::vector<raster::Draw> volumes = draws_of(frame, haller_label::kAllVolumes);
  ASSERT_EQ(volumes.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(volumes[i].state.cull, i < 2 ? raster::Cull::back : raster::Cull::front);
    EXPECT_EQ(volumes[i].state.stencil->front.pass,
              i < 2 ? raster::StencilOp::incr : raster::StencilOp::decr);
  }
}

TEST(Haller, VolumeIsDrawnWithTheMatrixOfItsObject) {
  const Shot shot = small_shot();
  Buffers buffers;
  const raster::Frame frame = buffers.record(shot.scene, shot.camera, {});
  const raster::Draw torus = draws_of(frame, haller_label::kVirtualLit).at(0);
  const raster::Draw volume = draws_of(frame, haller_label::kAllVolumes).at(1);
  EXPECT_EQ(torus.clip_from_model, volume.clip_from_model);
}

TEST(Haller, WrongTargetsAndPhotographsAreMisuse) {
  const Shot shot = small_shot();
  Buffers buffers;
  raster::Targets targets = buffers.targets();
  targets.stencil = nullptr;
  EXPECT_THROW(record_haller(shot.scene, shot.camera, buffers.view(), targets),
               std::invalid_argument);
  raster::ImageView narrow = buffers.view();
  narrow.width -= 1;
  EXPECT_THROW(record_haller(shot.scene, shot.camera, narrow, buffers.targets()),
               std::invalid_argument);
}

/// What the three masks should be at a place, by rays.
struct RayMasks {
  bool shadow_on_real = false, shadow_on_virtual = false, virtual_visible = false;
};

RayMasks ray_masks(const RayReference& rays, const Scene& scene, const Ray& ray) {
  RayMasks result;
  const glm::vec4 light = scene.lights[0].position;
  const RayHit hit = rays.trace(ray);
  if (!hit.hit) return result;
  result.virtual_visible = scene.objects[hit.object].role == Role::virtual_object;
  const bool by_real = rays.shadow(hit, light, Among::phantoms).in_shadow;
  const bool by_virtual = rays.shadow(hit, light, Among::virtual_objects).in_shadow;
  result.shadow_on_virtual = result.virtual_visible && by_real && !by_virtual;
  result.shadow_on_real = !result.virtual_visible && !by_real && by_virtual;
  return result;
}

using MaskOf = std::function<bool(const RayMasks&)>;

struct MaskErrors {
  std::size_t set = 0, wrong = 0, unexplained = 0;
};

void compare_mask(const Buffers& buffers, std::size_t channel, const Shot& shot,
                  const RayReference& rays, const MaskOf& mask_of, MaskErrors& errors) {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool drawn = buffers.masks.rgba8().at(x, y)[channel] != 0;
      errors.set += drawn;
      const auto wanted = [&](double px, double py) {
        return mask_of(ray_masks(rays, shot.scene, window_ray(shot.camera, px, py)));
      };
      if (wanted(x + 0.5, y + 0.5) == drawn) continue;
      ++errors.wrong;
      bool edge = false;
      for (int j = -6; j <= 6 && !edge; ++j) {
        for (int i = -6; i <= 6 && !edge; ++i) {
          edge = wanted(x + 0.5 + i / 6.0, y + 0.5 + j / 6.0) == drawn;
        }
      }
      errors.unexplained += !edge;
    }
  }
}

// Oracle: Embree's rays through the same scene.
TEST(Haller, MasksEqualTheRaysButForPixelsAtEdges) {
  std::mt19937 random(60);
  std::array<MaskErrors, 3> errors;
  for (int i = 0; i < 60; ++i) {
    const Shot shot = random_shot(random);
    Buffers buffers;
    buffers.draw(shot.scene, shot.camera, {.masks = &buffers.masks});
    const RayReference rays(shot.scene);
    const std::array<MaskOf, 3> masks = {[](const RayMasks& m) { return m.shadow_on_real; },
                                         [](const RayMasks& m) { return m.shadow_on_virtual; },
                                         [](const RayMasks& m) { return m.virtual_visible; }};
    for (std::size_t k = 0; k < 3; ++k) {
      compare_mask(buffers, k, shot, rays, masks[k], errors[k]);
    }
  }
  const std::array<const char*, 3> names = {"shadow on real", "shadow on virtual", "object"};
  for (std::size_t k = 0; k < 3; ++k) {
    std::printf("%s mask: %zu pixels set, %zu differ from the rays, %zu of them not at an edge\n",
                names[k], errors[k].set, errors[k].wrong, errors[k].unexplained);
    EXPECT_EQ(errors[k].unexplained, 0u);
    EXPECT_GT(errors[k].set, 2000u);
    EXPECT_LT(errors[k].wrong, errors[k].set / 100);
  }
}

// Oracle: the photograph's own bytes, and its bytes times 1 - share, rounded.
TEST(Haller, PhotographKeepsItsBytesOutsideObjectsAndShadows) {
  std::mt19937 random(61);
  std::size_t kept = 0, darkened = 0;
  for (int i = 0; i < 10; ++i) {
    const Shot shot = random_shot(random);
    Buffers buffers;
    buffers.draw(shot.scene, shot.camera, {.masks = &buffers.masks});
    const raster::ImageView view = buffers.view();
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const raster::Rgba8 got = buffers.color.rgba8().at(x, y);
        const raster::Rgba8 mask = buffers.masks.rgba8().at(x, y);
        EXPECT_EQ(got[3], mask[2]);
        if (mask[2]) continue;
        EXPECT_EQ(got[3], 0);
        const double rest = mask[0] ? 1.0 - static_cast<double>(shot.scene.lights[0].share) : 1.0;
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_NEAR(got[c], rest * view.pixel(x, y)[c], mask[0] ? 0.501 : 0.0);
        }
        ++(mask[0] ? darkened : kept);
      }
    }
  }
  EXPECT_GT(kept, 100000u);
  EXPECT_GT(darkened, 2000u);
}

TEST(Haller, MasksDoNotChangeThePicture) {
  std::mt19937 random(62);
  for (int i = 0; i < 6; ++i) {
    Shot shot = random_shot(random);
    if (i % 2) shot.scene.lights = three_lights(shot.scene.lights[0]);
    Buffers plain, masked;
    plain.draw(shot.scene, shot.camera, {});
    masked.draw(shot.scene, shot.camera, {.masks = &masked.masks});
    EXPECT_EQ(plain.color.to_rgba8_rows(), masked.color.to_rgba8_rows());
    EXPECT_EQ(plain.depth.to_rows(), masked.depth.to_rows());
  }
}

TEST(Haller, SameBytesAtEveryNumberOfThreads) {
  std::mt19937 random(63);
  for (int i = 0; i < 4; ++i) {
    Shot shot = random_shot(random);
    if (i % 2) shot.scene.lights = three_lights(shot.scene.lights[0]);
    Buffers one;
    one.draw(shot.scene, shot.camera, {.masks = &one.masks}, 1);
    for (const int threads : {2, 3, 7, 16}) {
      Buffers many;
      many.draw(shot.scene, shot.camera, {.masks = &many.masks}, threads);
      EXPECT_EQ(one.color.to_rgba8_rows(), many.color.to_rgba8_rows());
      EXPECT_EQ(one.masks.to_rgba8_rows(), many.masks.to_rgba8_rows());
      EXPECT_EQ(one.depth.to_rows(), many.depth.to_rows());
      EXPECT_EQ(one.stencil.to_rows(), many.stencil.to_rows());
    }
  }
}

// Oracle: saturating and wrapping counts are the same below 255 volumes.
TEST(Haller, AppendixLetterDrawsTheSamePicture) {
  std::mt19937 random(64);
  for (int i = 0; i < 6; ++i) {
    const Shot shot = random_shot(random);
    Buffers modern, letter;
    modern.draw(shot.scene, shot.camera, {});
    letter.draw(shot.scene, shot.camera, {.appendix_letter = true});
    EXPECT_EQ(modern.color.to_rgba8_rows(), letter.color.to_rgba8_rows());
    EXPECT_EQ(modern.stencil.to_rows(), letter.stencil.to_rows());
  }
}

// Oracle: light is additive. Float32 channels keep the sum within a few roundings.
TEST(Haller, ThreeLightsInOnePlaceAreTheOneLight) {
  std::mt19937 random(65);
  for (int i = 0; i < 6; ++i) {
    Shot shot = random_shot(random);
    Buffers one(raster::ColorFormat::rgba32f), three(raster::ColorFormat::rgba32f);
    one.draw(shot.scene, shot.camera, {});
    shot.scene.lights = three_lights(shot.scene.lights[0]);
    three.draw(shot.scene, shot.camera, {});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::vec4 a = one.color.at(x, y), b = three.color.at(x, y);
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(a[c], b[c], 1e-5f) << x << " " << y << " " << i;
      }
    }
  }
}

// Oracle: each light's own mask; two lights take away the sum of their shares.
TEST(Haller, EachLightDarkensByItsOwnShare) {
  Shot shot = small_shot();
  shot.scene.lights = {{.name = "a", .position = {0.5f, 4, 0.5f, 1}, .share = 0.25f},
                       {.name = "b", .position = {-0.5f, 4, -0.2f, 1}, .share = 0.5f}};
  Buffers both(raster::ColorFormat::rgba32f);
  both.draw(shot.scene, shot.camera, {});
  std::vector<Buffers> single(2);
  for (std::size_t i = 0; i < 2; ++i) {
    Shot alone = shot;
    alone.scene.lights = {shot.scene.lights[i]};
    single[i].draw(alone.scene, alone.camera, {.masks = &single[i].masks});
  }
  std::array<std::size_t, 4> seen{};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (single[0].masks.rgba8().at(x, y)[2]) continue;
      const bool a = single[0].masks.rgba8().at(x, y)[0], b = single[1].masks.rgba8().at(x, y)[0];
      ++seen[2 * a + b];
      const float rest = 1.0f - (a ? 0.25f : 0.0f) - (b ? 0.5f : 0.0f);
      const float photo = static_cast<float>(both.view().pixel(x, y)[1]) / 255.0f;
      ASSERT_NEAR(both.color.at(x, y).g, rest * photo, 1e-5f);
    }
  }
  for (const std::size_t count : seen) EXPECT_GT(count, 100u);
}

// Oracle: the paper to the letter differs exactly where a phantom's volume holds the real surface.
TEST(Haller, DoubleShadowsDarkenMoreAndOnlyWhereARealShadowIs) {
  std::mt19937 random(66);
  std::size_t twice = 0;
  for (int i = 0; i < 10; ++i) {
    const Shot shot = random_shot(random);
    const RayReference rays(shot.scene);
    Buffers once, both;
    once.draw(shot.scene, shot.camera, {.masks = &once.masks});
    both.draw(shot.scene, shot.camera, {.double_shadows = true, .masks = &both.masks});
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool a = once.masks.rgba8().at(x, y)[0], b = both.masks.rgba8().at(x, y)[0];
        EXPECT_TRUE(b || !a);
        twice += b && !a;
      }
    }
  }
  EXPECT_GT(twice, 2000u);
}

// Oracle: rays to each of the 16 points; darkening comes in whole sixteenths of the share.
TEST(Haller, LightWithARadiusDarkensByTheCountOfItsHiddenSamples) {
  Shot shot = small_shot();
  Light& light = shot.scene.lights[0];
  light.radius = 0.3f;
  light.samples = 16;
  light.share = 0.8f;
  Buffers buffers(raster::ColorFormat::rgba32f);
  buffers.draw(shot.scene, shot.camera, {.masks = &buffers.masks});
  const RayReference rays(shot.scene);
  const std::vector<Light> samples = sample_lights(shot.scene);
  std::size_t penumbra = 0, tested = 0, off_by_more_than_one = 0;
  for (int y = 0; y < kHeight; y += 3) {
    for (int x = 0; x < kWidth; x += 3) {
      if (buffers.masks.rgba8().at(x, y)[2]) continue;
      const float photo = static_cast<float>(buffers.view().pixel(x, y)[0]) / 255.0f;
      const float hidden = (1.0f - buffers.color.at(x, y).r / photo) / light.share * 16.0f;
      EXPECT_NEAR(hidden, std::round(hidden), 1e-3f);
      const RayHit hit = rays.trace(window_ray(shot.camera, x + 0.5, y + 0.5));
      int expected = 0;
      for (const Light& sample : samples) {
        expected += rays.shadow(hit, sample.position, Among::virtual_objects).in_shadow &&
                    !rays.shadow(hit, sample.position, Among::phantoms).in_shadow;
      }
      ++tested;
      penumbra += expected > 0 && expected < 16;
      off_by_more_than_one += std::abs(hidden - static_cast<float>(expected)) > 1.5f;
    }
  }
  EXPECT_GT(penumbra, 100u);
  EXPECT_EQ(off_by_more_than_one, 0u);
  EXPECT_GT(tested, 5000u);
}

// Oracle: the definition of receiving and casting.
TEST(Haller, ObjectsThatDoNotReceiveOrCastAreLeftAlone) {
  Shot shot = small_shot();
  Buffers plain, deaf, weightless;
  plain.draw(shot.scene, shot.camera, {.masks = &plain.masks});
  shot.scene.objects[0].receives = false;
  deaf.draw(shot.scene, shot.camera, {.masks = &deaf.masks});
  shot.scene.objects[0].receives = true;
  shot.scene.objects[1].casts = false;
  weightless.draw(shot.scene, shot.camera, {.masks = &weightless.masks});
  const auto shadowed = [](const Buffers& buffers) {
    std::size_t count = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) count += buffers.masks.rgba8().at(x, y)[0] != 0;
    }
    return count;
  };
  EXPECT_GT(shadowed(plain), 500u);
  EXPECT_EQ(shadowed(deaf), 0u);
  EXPECT_EQ(shadowed(weightless), 0u);
}

TEST(Haller, SceneWithoutLightsOrObjectsIsThePhotograph) {
  Buffers buffers;
  buffers.draw({}, test::look({0, 0, 5}, {0, 0, 0}, kWidth, kHeight), {.masks = &buffers.masks});
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const raster::Rgba8 got = buffers.color.rgba8().at(x, y);
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(got[c], buffers.view().pixel(x, y)[c]);
      ASSERT_EQ(got[3], 0);
    }
  }
}

}  // namespace
}  // namespace gnomon::pipeline
