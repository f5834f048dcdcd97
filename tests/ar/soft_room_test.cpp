// The captured room of examples/soft, from its files to pictures. Oracles: the true pose of its
// camera; photographs of the real objects (tests/data/soft); the session's own other threads.
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "ar/image_file.h"
#include "ar/lit_scene_file.h"
#include "ar/metrics.h"
#include "ar/scene_file.h"
#include "ar/scene_light.h"
#include "ar/session.h"
#include "temporary_folder.h"

namespace gnomon::ar {
namespace {

const std::filesystem::path kSoft = GNOMON_SOURCE_DIR "/examples/soft";
const std::filesystem::path kTruth = GNOMON_SOURCE_DIR "/tests/data/soft";

class SoftRoom : public testing::Test {
 protected:
  SoftRoom() {
    static const pipeline::LitScene kScene =
        find_scene_light(read_capture(kSoft), {.patches = 800, .visibility_samples = 1}).scene;
    write_lit_scene(folder_.path() / "room.lit", kScene);
  }
  SessionResult run(const char* scene, SessionOptions options) {
    options.lit_scene = folder_.path() / "room.lit";
    Session session(read_scene(kSoft / scene), background_.width, background_.height, options);
    return session.process(background_, 0.0);
  }

  TemporaryFolder folder_;
  Image background_ = read_image_rgb(kSoft / "background.png");
};

TEST_F(SoftRoom, TagsPlaceTheCameraAsItsKnownPoseDoes) {
  const SessionResult known = run("suzanne.toml", {.still = true}),
                      tracked = run("suzanne_tags.toml", {.passes = 50});
  ASSERT_TRUE(known.augmented && tracked.augmented);
  const glm::dvec3 apart =
      glm::dvec3((*known.world_from_camera)[3]) - glm::dvec3((*tracked.world_from_camera)[3]);
  // Three tags at 2 to 4 m, corners found to a few hundredths of a pixel.
  EXPECT_LT(glm::length(apart), 0.02);
  EXPECT_GT(*mask_iou(known.augmented->object_mask, tracked.augmented->object_mask), 0.97);
  // Sources are chosen for what the still camera sees, and for all of the room where it may move;
  // so the shadows are compared where the still one darkens.
  Image mask = known.augmented->shadow_mask;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i)
    if (tracked.augmented->object_mask.pixels[i] != 0) mask.pixels[i] = 0;
  const Image &still = known.augmented->composite, &moving = tracked.augmented->composite;
  const double apart_values = difference(still, moving, &mask).rmse,
               shadow = difference(background_, still, &mask).rmse;
  std::printf("rmse %.2f between the two, %.2f of the shadow\n", apart_values, shadow);
  EXPECT_LT(apart_values, 0.3 * shadow);
}

TEST_F(SoftRoom, TheShadowIsNearerToThePhotographThanNone) {
  const SessionResult result = run("suzanne.toml", {.still = true});
  ASSERT_TRUE(result.augmented);
  const Image photo = read_image_rgb(kTruth / "08_suzanne/photo.png");
  const Image real = read_image(kTruth / "08_suzanne/object_mask.png");
  Image mask = result.augmented->shadow_mask;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i)
    if (real.pixels[i * static_cast<std::size_t>(real.channels)] != 0) mask.pixels[i] = 0;
  const double with = difference(photo, result.augmented->composite, &mask).rmse,
               without = difference(photo, background_, &mask).rmse;
  std::printf("rmse %.2f with the shadow, %.2f without\n", with, without);
  EXPECT_LT(with, 0.6 * without);
}

TEST_F(SoftRoom, IsTheSameForEveryNumberOfThreadsThroughTheLens) {
  const SessionResult one = run("box.toml", {.still = true, .threads = 1});
  for (const int threads : {2, 5}) {
    const SessionResult more = run("box.toml", {.still = true, .threads = threads});
    EXPECT_TRUE(more.augmented->composite.pixels == one.augmented->composite.pixels);
    EXPECT_TRUE(more.augmented->shadow_mask.pixels == one.augmented->shadow_mask.pixels);
  }
}

}  // namespace
}  // namespace gnomon::ar
