// The least that a scene needs. Oracles: scenes of which it is known; the written scene, read again
// and drawn anew; the session that draws photographs.
#include <algorithm>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../pipeline/lit_room.h"
#include "../pipeline/test_meshes.h"
#include "ar/displacement.h"
#include "ar/error.h"
#include "ar/fit.h"
#include "ar/lit_scene_file.h"
#include "ar/model_writer.h"
#include "ar/scene_writer.h"
#include "ar/session.h"
#include "temporary_folder.h"

namespace gnomon::ar {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kWidth = 160, kHeight = 120;
constexpr const char* kCamera = R"(format = "gnomon-scene 1"
[camera]
fov_y_deg = 45
width = 160
height = 120
eye_m = [0.0, 1.2, 2.0]
target_m = [0.0, 0.2, 0.0]
)";
/// A ball above a floor; a crate behind the camera, which no ray of light and no look meets.
constexpr const char* kThings = R"(
[[object]]
name = "floor"
role = "phantom"
model = "floor.glb"
[[object]]
name = "crate"
role = "phantom"
model = "crate.glb"
position_m = [0.0, 0.5, 9.0]
[[object]]
name = "ball"
role = "virtual"
model = "ball.glb"
position_m = [0.0, 0.6, 0.0]
[[light]]
name = "lamp"
position_m = [0.8, 3.0, 0.6]
[[caster]]
node = "crate"
[[caster]]
node = "ball"
)";
constexpr std::size_t kBallTriangles = 20 * 64;

class Fit : public testing::Test {
 protected:
  Fit() {
    write_model(folder_.path() / "floor.glb", *test::model_of(test::square_mesh(2.0f)));
    write_model(folder_.path() / "crate.glb", *test::model_of(test::box_mesh(glm::vec3(0.3f))));
    write_model(folder_.path() / "ball.glb", *test::model_of(test::icosphere_mesh(0.25f, 3)));
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int c = 0; c < 3; ++c)
          photograph_.pixels.push_back(static_cast<std::uint8_t>(90 + (x * 7 + y * 5 + c) % 60));
  }

  SceneFile scene(const std::string& rest = kThings) const {
    std::ofstream(folder_.path() / "scene.toml") << kCamera << rest;
    return read_scene(folder_.path() / "scene.toml");
  }
  static FitOptions within(const char* error) {
    return {.bound = parse_error_bound(error), .repeat = 1, .threads = 2};
  }
  std::vector<NamedPicture> photographs() const { return {{"photo.png", photograph_}}; }

  /// Written beside the scene, in a folder of its own, and read again.
  SceneFile written(const FitResult& result) const {
    const fs::path folder = folder_.path() / "out";
    fs::remove_all(folder);
    fs::create_directories(folder);
    write_fit_scene(result.given, result.fitted, folder, folder);
    return read_scene(folder / "scene.toml");
  }

  static const FitFinding& finding(const FitResult& result, const std::string& item) {
    const auto found = std::ranges::find(result.findings, item, &FitFinding::item);
    if (found == result.findings.end()) throw std::runtime_error("no item " + item);
    return *found;
  }

  TemporaryFolder folder_;
  Image photograph_{kWidth, kHeight, 3, {}};
};

TEST_F(Fit, DropsAPhantomThatTouchesNothingAndKeepsTheOneThatIsShadowed) {
  Fitter fitter(scene(), photographs(), within("1px"));
  const FitResult result = fitter.search();
  EXPECT_EQ(finding(result, "phantom 'crate'").outcome, "dropped");
  EXPECT_EQ(finding(result, "shadow of phantom 'crate'").outcome, "gone with the phantom");
  EXPECT_NE(finding(result, "phantom 'floor'").outcome, "dropped");
  const SceneFile file = written(result);
  ASSERT_EQ(file.objects.size(), 2u);
  EXPECT_EQ(file.objects[0].name, "floor");
  ASSERT_EQ(file.casters.size(), 1u);
  EXPECT_EQ(file.casters[0].node, "ball");
}

TEST_F(Fit, ReducesAFineCasterWithinTheBoundAndLeavesWhatIsDrawn) {
  Fitter fitter(scene(), photographs(), within("1px"));
  const FitResult result = fitter.search();
  const FitFinding& ball = finding(result, "shadow of 'ball'");
  EXPECT_EQ(ball.outcome, "reduced");
  EXPECT_LT(ball.taken_amount, kBallTriangles / 2);
  EXPECT_EQ(result.before.totals.casting_triangles, kBallTriangles + 12 + 2);
  EXPECT_EQ(result.before.error, 0.0);
  EXPECT_LE(result.after.error, 1.0);
  // The next less was measured, and is outside.
  ASSERT_TRUE(ball.next.has_value());
  EXPECT_GT(ball.next_error, 1.0);
  const SceneFile file = written(result);
  EXPECT_EQ(file.objects[1].model.filename(), "ball.glb");
  EXPECT_EQ(fs::canonical(file.objects[1].model), fs::canonical(folder_.path() / "ball.glb"));
  EXPECT_FALSE(file.objects[1].shadow_model.empty());
}

TEST_F(Fit, TheWrittenSceneHasTheErrorThatWasClaimed) {
  const SceneFile given = scene();
  Fitter fitter(given, photographs(), within("1px"));
  const FitResult result = fitter.search();
  const SceneFile file = written(result);
  EXPECT_EQ(fitter.error_of(load_fit_scene(file)), result.after.error);
  // By the session, which knows nothing of the search.
  Image grey = photograph_;
  std::ranges::fill(grey.pixels, std::uint8_t{192});
  const auto drawn = [&](const SceneFile& of) {
    return Session(of, kWidth, kHeight, {.still = true}).process(grey, 0.0).augmented->composite;
  };
  EXPECT_EQ(displacement(drawn(given), drawn(file)).px, result.after.error);
}

TEST_F(Fit, ATighterBoundNeverTakesFewerTriangles) {
  std::size_t before = 0;
  for (const char* error : {"4px", "2px", "1px"}) {
    Fitter fitter(scene(), photographs(), within(error));
    const FitResult result = fitter.search();
    EXPECT_GE(result.after.totals.casting_triangles, before) << error;
    before = result.after.totals.casting_triangles;
  }
}

TEST_F(Fit, HoldsABoundOfFlip) {
  Fitter fitter(scene(), photographs(), within("0.08flip"));
  const FitResult result = fitter.search();
  EXPECT_LE(result.after.error, 0.08);
  EXPECT_LT(finding(result, "shadow of 'ball'").taken_amount, kBallTriangles);
}

TEST_F(Fit, ReplacesAShadowModelThatIsTooCoarse) {
  write_model(folder_.path() / "coarse.glb", *test::model_of(test::icosphere_mesh(0.25f, 0)));
  std::string things = kThings;
  things.replace(things.find("model = \"ball.glb\""), 18,
                 "model = \"ball.glb\"\nshadow_model = \"coarse.glb\"");
  Fitter fitter(scene(things), photographs(), within("1px"));
  const FitResult result = fitter.search();
  EXPECT_GT(result.before.error, 1.0);
  EXPECT_LE(result.after.error, 1.0);
  EXPECT_EQ(finding(result, "shadow of 'ball'").outcome, "raised");
}

TEST_F(Fit, OfASceneByItselfFindsWhatEachLightNeeds) {
  std::string things = kThings;
  things =
      things.substr(0, things.find("[[caster]]")) + "[[caster]]\nmethod = \"map\"\nsize = 16\n";
  Fitter fitter(scene(things), {}, within("1px"));
  const FitResult result = fitter.search();
  EXPECT_GT(result.before.error, 1.0);
  EXPECT_LE(result.after.error, 1.0);
  EXPECT_NE(finding(result, "shadows of light 'lamp'").taken, "as given");
  // Drawn phantoms are part of the picture.
  EXPECT_EQ(written(result).objects.size(), 3u);
  EXPECT_EQ(fitter.error_of(load_fit_scene(written(result))), result.after.error);
}

TEST_F(Fit, OfDifferentialShadowsFindsPassesSourcesAndOccluders) {
  pipeline::LitScene lit = test::lit_room({.patches = 300});
  lit.probe = {2, 1, {glm::vec3(1.0f), glm::vec3(1.0f)}, {}};
  write_lit_scene(folder_.path() / "room.lit", lit);
  const SceneFile file = scene(
      "[differential]\nbudget_ms = 16\n[[object]]\nname = \"ball\"\nrole = \"virtual\"\n"
      "model = \"ball.glb\"\nposition_m = [0.3, 0.4, 0.0]\n");
  FitOptions options = within("0.05flip");
  options.lit_scene = folder_.path() / "room.lit";
  Fitter fitter(file, photographs(), options);
  const FitResult result = fitter.search();
  EXPECT_LE(result.after.error, 0.05);
  EXPECT_LT(result.after.totals.casting_triangles, kBallTriangles);
  const SceneFile again = written(result);
  ASSERT_TRUE(again.differential.has_value());
  // The scene says all itself: no --lit-scene, no clock.
  EXPECT_EQ(fs::canonical(again.differential->lit_scene),
            fs::canonical(folder_.path() / "room.lit"));
  EXPECT_EQ(again.differential->settings.budget_ms, 0.0);
  EXPECT_EQ(fitter.error_of(load_fit_scene(again)), result.after.error);
}

TEST_F(Fit, SaysWhatItNeeds) {
  const SceneFile file = scene(
      "[differential]\nlit_scene = \"scene.toml\"\n[[object]]\n"
      "name = \"ball\"\nrole = \"virtual\"\nmodel = \"ball.glb\"\n");
  try {
    Fitter fitter(file, {}, within("1px"));
    FAIL() << "no photograph";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("fall on a photograph"));
  }
}

TEST(SceneWriter, KeepsASceneThatNothingChangedIn) {
  const fs::path examples = GNOMON_SOURCE_DIR "/examples/desk";
  const SceneFile file = read_scene(examples / "04_torus_and_sphere_on_tin.toml");
  const TemporaryFolder folder;
  const FitScene scene = load_fit_scene(file);
  write_fit_scene(scene, scene, folder.path(), folder.path());
  const SceneFile again = read_scene(folder.path() / "scene.toml");
  EXPECT_FALSE(fs::exists(folder.path() / "models"));
  EXPECT_EQ(fs::canonical(again.camera_file), fs::canonical(file.camera_file));
  EXPECT_EQ(again.ambient, file.ambient);
  EXPECT_EQ(again.near_m, file.near_m);
  ASSERT_EQ(again.tags.world.tags.size(), file.tags.world.tags.size());
  for (std::size_t i = 0; i < file.tags.world.tags.size(); ++i)
    EXPECT_EQ(again.tags.world.tags[i].body_from_tag, file.tags.world.tags[i].body_from_tag);
  ASSERT_EQ(again.objects.size(), file.objects.size());
  for (std::size_t i = 0; i < file.objects.size(); ++i) {
    EXPECT_EQ(again.objects[i].name, file.objects[i].name);
    EXPECT_EQ(fs::canonical(again.objects[i].model), fs::canonical(file.objects[i].model));
    EXPECT_EQ(again.objects[i].body_from_object, file.objects[i].body_from_object);
    EXPECT_EQ(again.objects[i].attached_to, file.objects[i].attached_to);
  }
  EXPECT_EQ(again.casters.size(), file.casters.size());
  EXPECT_EQ(again.lights[0].share, file.lights[0].share);
}

}  // namespace
}  // namespace gnomon::ar
