#include "pipeline/differential_method.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "pipeline/differential_reference.h"
#include "pipeline/finish_picture.h"
#include "raster/execute.h"
#include "raster/isa.h"
#include "tests/pipeline/lit_room.h"
#include "tests/pipeline/test_meshes.h"

namespace gnomon::pipeline {
namespace {

constexpr int kWidth = 160, kHeight = 120;

struct Picture {
  raster::ColorBuffer color;
  raster::DepthBuffer depth{kWidth, kHeight};
  raster::StencilBuffer stencil{kWidth, kHeight};
  explicit Picture(raster::ColorFormat format = raster::ColorFormat::rgba8)
      : color(kWidth, kHeight, format) {}
  raster::Targets targets() { return {&color, &depth, &stencil}; }
};

/// A room, a camera in it, and as its photograph what the reference makes of no object at all: each
/// point's own radiance.
struct Setting {
  LitScene scene;
  LightPaths paths;
  Camera camera = test::look({0.6f, 1.2f, 1.8f}, {0.1f, 0.2f, -0.4f}, kWidth, kHeight, 60.0f);
  std::vector<std::uint8_t> rows;

  explicit Setting(const test::RoomOptions& options = {.patches = 600},
                   const LightPathOptions& light = {.transfer = {.power_share = 1.0}})
      : scene(test::lit_room(options)) {
    std::vector<std::uint32_t> all(scene.model.patches.size());
    std::iota(all.begin(), all.end(), 0u);
    paths = find_light_paths(scene, all, light);
    const PatchVisibility visibility(scene.model);
    for (const Ray& ray : pixel_rays(camera)) {
      const auto hit = visibility.trace(ray.origin, ray.direction);
      glm::dvec3 radiance(0.0);
      for (std::size_t k = 0; k < 3; ++k) {
        radiance += glm::dvec3(paths.vertex_radiance[scene.model.patches[hit.patch].vertices[k]]) *
                    hit.weights[static_cast<int>(k)];
      }
      for (std::size_t c = 0; c < 3; ++c)
        rows.push_back(static_cast<std::uint8_t>(
            std::lround(scene.tone.value(c, radiance[static_cast<int>(c)]))));
    }
  }
  raster::ImageView photograph() const {
    return {rows.data(), kWidth, kHeight, 3, std::ptrdiff_t{3} * kWidth};
  }
};

Scene ball_at(const glm::vec3& center) {
  Scene scene;
  scene.objects.push_back({.name = "ball",
                           .model = test::model_of(test::icosphere_mesh(0.2f, 2)),
                           .world_from_model = test::placed(center)});
  return scene;
}

std::vector<std::uint8_t> draw(DifferentialMethod& method, const Setting& setting,
                               const Scene& objects, const DifferentialOptions& options,
                               int threads = 1, raster::Isa isa = raster::Isa::best) {
  const ShadowPrecision precision = options.take.precision;
  const bool wide = precision == ShadowPrecision::values || precision == ShadowPrecision::radiance;
  Picture picture(wide ? raster::ColorFormat::rgba32f : raster::ColorFormat::rgba8);
  const raster::ImageView photograph = setting.photograph();
  const raster::Frame frame =
      method.record(objects, setting.camera, photograph, picture.targets(), options);
  raster::execute(frame, {.threads = threads, .isa = isa});
  return finish_picture(photograph, picture.color, setting.scene.tone, options.take);
}

std::vector<std::uint8_t> draw(const Setting& setting, const Scene& objects,
                               const DifferentialOptions& options) {
  DifferentialMethod method(setting.scene, setting.paths);
  return draw(method, setting, objects, options);
}

constexpr ShadowPrecision kPrecisions[] = {ShadowPrecision::bytes, ShadowPrecision::dithered,
                                           ShadowPrecision::values, ShadowPrecision::radiance};

double rms(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
           std::size_t channels_b, const std::vector<std::uint8_t>& where) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < where.size(); ++i) {
    if (!where[i]) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = static_cast<double>(a[4 * i + c]) - b[channels_b * i + c];
      sum += d * d;
      ++count;
    }
  }
  return std::sqrt(sum / static_cast<double>(count));
}

TEST(Differential, WithoutAnObjectThePhotographKeepsItsBytes) {
  const Setting setting;
  for (const ShadowPrecision precision : kPrecisions) {
    const auto out = draw(setting, {}, {.take = {.precision = precision}});
    for (std::size_t i = 0; i < setting.rows.size() / 3; ++i) {
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(out[4 * i + c], setting.rows[3 * i + c]);
      ASSERT_EQ(out[4 * i + 3], 0);
    }
  }
}

TEST(Differential, OutsideTheShadowAndTheObjectThePhotographKeepsItsBytes) {
  const Setting setting;
  const Scene ball = ball_at({0.3f, 0.25f, 0.0f});
  const auto out = draw(setting, ball, {});
  std::size_t changed = 0;
  for (std::size_t i = 0; i < setting.rows.size() / 3; ++i) {
    bool same = true;
    for (std::size_t c = 0; c < 3; ++c) {
      if (out[4 * i + 3] == 0) {
        EXPECT_LE(out[4 * i + c], setting.rows[3 * i + c]);
      }
      same = same && out[4 * i + c] == setting.rows[3 * i + c];
    }
    changed += same ? 0 : 1;
  }
  EXPECT_GT(changed, 500u);
  EXPECT_LT(changed, static_cast<std::size_t>(kWidth * kHeight) * 9 / 10);
}

// Oracle: rays to sixteen points of every patch.
TEST(Differential, IsNearTheReferenceAndNearerWithMorePasses) {
  const Setting setting;
  const Scene ball = ball_at({0.3f, 0.3f, 0.0f});
  const DifferentialReference reference(setting.scene, ball);
  const auto exact = reference.render(pixel_rays(setting.camera), setting.rows, {.samples = 16});
  std::vector<std::uint8_t> where;
  for (std::size_t i = 0; i < exact.shadow.size(); ++i)
    where.push_back(exact.shadow[i] && !exact.object[i] ? 1 : 0);
  std::vector<std::uint8_t> photograph;
  for (std::size_t i = 0; i < setting.rows.size(); i += 3)
    photograph.insert(photograph.end(),
                      {setting.rows[i], setting.rows[i + 1], setting.rows[i + 2], 0});
  const double nothing = rms(photograph, exact.pixels, 3, where);
  double before = nothing;
  for (const std::size_t passes : {2, 10, 600}) {
    const double error = rms(
        draw(setting, ball, {.take = {.passes = passes, .precision = ShadowPrecision::radiance}}),
        exact.pixels, 3, where);
    std::printf("%zu passes: rms %.3f of %.3f\n", passes, error, nothing);
    EXPECT_LT(error, before) << passes;
    before = error;
  }
  EXPECT_LT(before, 0.15 * nothing);
}

// Oracle: the reference's own picture of black objects; floor beside a light ball keeps more light.
TEST(Differential, ObjectsGiveBackLightAsInTheReference) {
  const Setting setting;
  Scene ball = ball_at({0.3f, 0.3f, 0.0f});
  Model model = *ball.objects[0].model;
  model.parts[0].material.diffuse = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
  ball.objects[0].model = std::make_shared<const Model>(model);
  const DifferentialReference reference(setting.scene, ball);
  const auto rays = pixel_rays(setting.camera);
  const auto with = reference.render(rays, setting.rows, {}),
             without = reference.render(rays, setting.rows, {.returned_light = false});
  std::vector<std::uint8_t> where;
  double returned = 0.0;
  for (std::size_t i = 0; i < with.shadow.size(); ++i) {
    where.push_back(with.shadow[i] && !with.object[i] ? 1 : 0);
    if (where.back()) returned += with.pixels[3 * i] - without.pixels[3 * i];
  }
  EXPECT_GT(returned, 0.0);
  const auto draw_with = [&](bool returned_light) {
    return draw(setting, ball,
                {.take = {.passes = 600,
                          .precision = ShadowPrecision::radiance,
                          .returned_light = returned_light}});
  };
  const double near = rms(draw_with(true), with.pixels, 3, where),
               far = rms(draw_with(false), with.pixels, 3, where);
  std::printf("rms to the reference: %.3f, of a black ball %.3f\n", near, far);
  EXPECT_LT(near, 0.7 * far);
}

// Oracle: the reference, which asks rays of the sun as of every other patch.
TEST(Differential, TheSunIsASourceWithAHardShadow) {
  const Setting setting({.patches = 600, .sun_irradiance = 15.0f});
  const Scene ball = ball_at({0.3f, 0.6f, 0.0f});
  const DifferentialReference reference(setting.scene, ball);
  const auto exact = reference.render(pixel_rays(setting.camera), setting.rows, {});
  std::vector<std::uint8_t> where, photograph;
  for (std::size_t i = 0; i < exact.shadow.size(); ++i) {
    where.push_back(exact.shadow[i] && !exact.object[i] ? 1 : 0);
    photograph.insert(photograph.end(),
                      {setting.rows[3 * i], setting.rows[3 * i + 1], setting.rows[3 * i + 2], 0});
  }
  const double nothing = rms(photograph, exact.pixels, 3, where);
  for (const ShadowMask mask : {ShadowMask::map, ShadowMask::volumes}) {
    const double error =
        rms(draw(setting, ball,
                 {.take = {.passes = 600, .precision = ShadowPrecision::radiance}, .mask = mask}),
            exact.pixels, 3, where);
    std::printf("sun, mask %d: rms %.3f of %.3f\n", static_cast<int>(mask), error, nothing);
    EXPECT_LT(error, 0.2 * nothing);
  }
}

TEST(Differential, VolumesAndMapsAgreeButForTexelsAlongOutlines) {
  const Setting setting;
  const Scene ball = ball_at({0.3f, 0.3f, 0.0f});
  const auto maps = draw(setting, ball, {.map_size = 1024});
  const auto volumes = draw(setting, ball, {.mask = ShadowMask::volumes});
  std::vector<std::uint8_t> all(maps.size() / 4, 1);
  EXPECT_LT(rms(maps, volumes, 4, all), 0.6);
}

// Oracle: the picture of what casts, byte for byte wherever that would not be seen itself.
TEST(Differential, AShadowModelCastsInTheObjectsPlace) {
  const Setting setting;
  Scene box = ball_at({0.3f, 0.3f, 0.0f});
  box.objects[0].model = test::model_of(test::box_mesh(glm::vec3(0.25f)));
  Scene ball = ball_at({0.3f, 0.3f, 0.0f});
  const auto plain = draw(setting, ball, {});
  ball.objects[0].shadow_model = box.objects[0].model;
  for (const ShadowMask mask : {ShadowMask::map, ShadowMask::volumes}) {
    const auto expected = draw(setting, box, {.mask = mask}),
               got = draw(setting, ball, {.mask = mask});
    std::size_t compared = 0, unlike_the_balls = 0;
    for (std::size_t i = 0; i < expected.size() / 4; ++i) {
      if (expected[4 * i + 3] != 0) continue;
      ++compared;
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_EQ(got[4 * i + c], expected[4 * i + c]) << i;
        unlike_the_balls += got[4 * i + c] != plain[4 * i + c];
      }
    }
    EXPECT_GT(compared, expected.size() / 8);
    EXPECT_GT(unlike_the_balls, 500u);
  }
}

// Oracle: what is taken in floats, not rounded at all.
/// Draws of objects in the passes that subtract.
std::size_t self_shadow_draws(const raster::Frame& frame, const std::string& object) {
  std::size_t count = 0;
  for (const raster::Pass& pass : frame.passes()) {
    if (!pass.label.starts_with(differential_label::kSubtract)) continue;
    for (const raster::Command& command : pass.commands) {
      const auto* draw = std::get_if<raster::Draw>(&command);
      count += draw && draw->label == object ? 1 : 0;
    }
  }
  return count;
}

// Oracles: a ball is convex, so it has no shadow of its own; a ball behind another has.
TEST(Differential, OnlyTrianglesWithACasterBeforeThemAreDrawnAgain) {
  const Setting setting;
  Scene scene = ball_at({0.4f, 0.5f, 0.0f});
  Picture alone, two, unshadowed;
  DifferentialMethod method(setting.scene, setting.paths);
  const auto record = [&](Picture& picture, bool self_shadows) {
    raster::Frame frame = method.record(scene, setting.camera, setting.photograph(),
                                        picture.targets(), {.self_shadows = self_shadows});
    raster::execute(frame);
    return frame;
  };
  EXPECT_EQ(self_shadow_draws(record(alone, true), "ball"), 0u);
  // Between the ball and the panel, out of the camera's way to the ball.
  scene.objects.push_back({.name = "other",
                           .model = test::model_of(test::icosphere_mesh(0.2f, 2)),
                           .world_from_model = test::placed({0.4f, 1.3f, -0.1f})});
  EXPECT_GT(self_shadow_draws(record(two, true), "ball"), 0u);
  EXPECT_EQ(self_shadow_draws(record(unshadowed, false), "ball"), 0u);
  std::size_t darker = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const raster::Rgba8 &with = two.color.rgba8().at(x, y),
                          &without = unshadowed.color.rgba8().at(x, y);
      if (with[3] == 0) continue;
      for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(with[c], without[c]);
      darker += with[0] < without[0] ? 1 : 0;
    }
  }
  EXPECT_GT(darker, 50u);
}

TEST(Differential, BytesLoseFaintShadowsAndDitherKeepsThemOnAverage) {
  const Setting setting;
  // Black, so that there are many faint shadows: dither is even over many, not over a few.
  const Scene ball = ball_at({0.3f, 0.5f, 0.0f});
  const auto taken = [&](ShadowPrecision precision) {
    DifferentialMethod method(setting.scene, setting.paths);
    Picture picture(precision == ShadowPrecision::values ? raster::ColorFormat::rgba32f
                                                         : raster::ColorFormat::rgba8);
    raster::execute(method.record(
        ball, setting.camera, setting.photograph(), picture.targets(),
        {.take = {
             .passes = 500, .precision = precision, .by_share = false, .returned_light = false}}));
    double sum = 0.0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const glm::vec4 at = picture.color.at(x, y);
        if (at.w == 0.0f)
          sum += setting.rows[static_cast<std::size_t>(3 * (y * kWidth + x))] - 255.0 * at.x;
      }
    }
    return sum;
  };
  const double exact = taken(ShadowPrecision::values), bytes = taken(ShadowPrecision::bytes),
               dithered = taken(ShadowPrecision::dithered);
  std::printf("taken: floats %.0f, bytes %.0f, dithered %.0f\n", exact, bytes, dithered);
  EXPECT_LT(bytes, 0.9 * exact);
  EXPECT_NEAR(dithered, exact, 0.05 * exact);
}

TEST(Differential, IsTheSameForEveryNumberOfThreadsAndVectorWidth) {
  const Setting setting;
  const Scene ball = ball_at({0.3f, 0.3f, 0.0f});
  DifferentialMethod method(setting.scene, setting.paths);
  for (const ShadowPrecision precision : kPrecisions) {
    for (const ShadowMask mask : {ShadowMask::map, ShadowMask::volumes}) {
      DifferentialOptions options{.take = {.passes = 12, .precision = precision, .threads = 1},
                                  .mask = mask};
      const auto expected = draw(method, setting, ball, options, 1, raster::Isa::scalar);
      for (const raster::Isa isa : raster::available_isas()) {
        for (const int threads : {1, 2, 3, 7}) {
          options.take.threads = threads;
          EXPECT_TRUE(draw(method, setting, ball, options, threads, isa) == expected);
        }
      }
    }
  }
}

// Oracle: a method that draws its first frame.
TEST(Differential, AMovingCameraAndObjectLeaveNothingBehind) {
  Setting setting;
  DifferentialMethod moving(setting.scene, setting.paths);
  const Camera home = setting.camera;
  for (const float turn : {0.0f, 0.4f, -0.3f, 0.0f}) {
    setting.camera =
        test::look({0.6f + turn, 1.2f, 1.8f}, {0.1f, 0.2f + turn, -0.4f}, kWidth, kHeight, 60.0f);
    const Scene ball = ball_at({0.3f - turn, 0.3f, 0.5f * turn});
    for (const ShadowMask mask : {ShadowMask::map, ShadowMask::volumes}) {
      const DifferentialOptions options{.take = {.passes = 20}, .mask = mask};
      EXPECT_EQ(draw(moving, setting, ball, options), draw(setting, ball, options)) << turn;
    }
  }
  EXPECT_EQ(setting.camera.clip_from_world, home.clip_from_world);
}

TEST(Differential, AnObjectAroundASourceIsLeftOutNotDrawnWrongly) {
  const Setting setting;
  DifferentialMethod method(setting.scene, setting.paths);
  Picture picture;
  const Scene ball = ball_at({0.4f, 2.9f, -0.2f});
  const raster::Frame frame =
      method.record(ball, setting.camera, setting.photograph(), picture.targets(), {});
  raster::execute(frame);
  EXPECT_GT(method.shadows().left_out, 0u);
}

TEST(Differential, OfADarkRoomChangesNothing) {
  Setting setting;
  std::fill(setting.scene.radiance.begin(), setting.scene.radiance.end(), glm::vec3(0.0f));
  std::vector<std::uint32_t> all(setting.scene.model.patches.size());
  std::iota(all.begin(), all.end(), 0u);
  setting.paths = find_light_paths(setting.scene, all, {});
  const auto out = draw(setting, ball_at({0.3f, 0.3f, 0.0f}), {});
  for (std::size_t i = 0; i < out.size() / 4; ++i) {
    if (out[4 * i + 3] == 0) {
      ASSERT_EQ(out[4 * i], setting.rows[3 * i]);
    }
  }
}

TEST(Differential, RefusesTargetsOfTheOtherFormat) {
  const Setting setting;
  DifferentialMethod method(setting.scene, setting.paths);
  Picture wide(raster::ColorFormat::rgba32f);
  EXPECT_THROW(method.record({}, setting.camera, setting.photograph(), wide.targets(), {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace gnomon::pipeline
