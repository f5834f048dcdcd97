// Differential shadows from a scene file to a picture. Oracles: the photograph itself where nothing
// is hidden; the same session with other threads; the reader's rules, one broken at a time.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../pipeline/lit_room.h"
#include "ar/error.h"
#include "ar/lit_scene_file.h"
#include "ar/scene_file.h"
#include "ar/session.h"
#include "temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::HasSubstr;

constexpr const char* kHead = R"(format = "gnomon-scene 1"
[camera]
fov_y_deg = 60
width = 160
height = 120
eye_m = [0.6, 1.2, 1.8]
target_m = [0.1, 0.2, -0.4]
)";
constexpr const char* kBox = R"([[object]]
name = "box"
role = "virtual"
model = "box.obj"
position_m = [0.3, 0.3, 0.0]
scale = 0.2
)";

class DifferentialSession : public testing::Test {
 protected:
  DifferentialSession() {
    pipeline::LitScene lit = test::lit_room({.patches = 400});
    lit.probe = {2, 1, {glm::vec3(1.0f), glm::vec3(1.0f)}, {}};
    write_lit_scene(folder_.path() / "room.lit", lit);
    std::ofstream(folder_.path() / "box.obj")
        << "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
           "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 4 8 7\nf 4 7 3\nf 1 5 8\n"
           "f 1 8 4\nf 2 3 7\nf 2 7 6\n";
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        for (int c = 0; c < 3; ++c)
          photograph_.pixels.push_back(static_cast<std::uint8_t>(90 + (x * 7 + y * 5 + c) % 60));
      }
    }
  }

  SceneFile scene(const std::string& differential) {
    std::ofstream(folder_.path() / "scene.toml") << kHead << differential << kBox;
    return read_scene(folder_.path() / "scene.toml");
  }
  std::string error_of(const std::string& differential) {
    try {
      scene(differential);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  SessionResult run(const SceneFile& file, const SessionOptions& options = {}) {
    Session session(file, 160, 120, options);
    return session.process(photograph_, 0.0);
  }

  TemporaryFolder folder_;
  Image photograph_{160, 120, 3, {}};
};

TEST_F(DifferentialSession, DarkensOnlyAndOnlyInTheShadow) {
  const SessionResult result = run(scene("[differential]\nlit_scene = \"room.lit\"\n"));
  ASSERT_TRUE(result.augmented && result.differential);
  EXPECT_GT(result.differential->shadows, 5u);
  EXPECT_LE(result.differential->shadows, 50u);
  const Augmented& out = *result.augmented;
  std::size_t darker = 0;
  for (std::size_t i = 0; i < out.object_mask.pixels.size(); ++i) {
    if (out.object_mask.pixels[i] != 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const int change = out.composite.pixels[3 * i + c] - photograph_.pixels[3 * i + c];
      EXPECT_LE(change, 0);
      EXPECT_TRUE(change == 0 || out.shadow_mask.pixels[i] != 0);
      darker += change < 0 ? 1 : 0;
    }
  }
  EXPECT_GT(darker, 500u);
}

TEST_F(DifferentialSession, IsTheSameForEveryNumberOfThreads) {
  const SceneFile file = scene("[differential]\nlit_scene = \"room.lit\"\npasses = 20\n");
  const SessionResult one = run(file, {.threads = 1});
  for (const int threads : {2, 5})
    EXPECT_TRUE(run(file, {.threads = threads}).augmented->composite.pixels ==
                one.augmented->composite.pixels);
}

TEST_F(DifferentialSession, TakesPassesFromTheCommandLineBeforeTheScene) {
  const SceneFile file = scene("[differential]\nlit_scene = \"room.lit\"\npasses = 20\n");
  EXPECT_EQ(run(file).differential->shadows, 20u);
  EXPECT_EQ(run(file, {.passes = 7}).differential->shadows, 7u);
}

TEST_F(DifferentialSession, HoldsABudgetFrameAfterFrame) {
  const SceneFile file = scene("[differential]\nlit_scene = \"room.lit\"\nbudget_ms = 60000\n");
  Session session(file, 160, 120, {});
  // No frame takes a minute, so the passes grow until every source has its own.
  std::size_t before = 0;
  for (int i = 0; i < 8; ++i) {
    const SessionResult result = session.process(photograph_, i / 30.0);
    EXPECT_GE(result.differential->shadows, before);
    before = result.differential->shadows;
  }
  EXPECT_GT(before, 20u);
}

TEST_F(DifferentialSession, NamesEachPassAsThePaperDoes) {
  const SessionResult result =
      run(scene("[differential]\nlit_scene = \"room.lit\"\npasses = 3\nmask = \"volumes\"\n"
                "by_share = false\n"),
          {.steps = true});
  std::vector<std::string> labels;
  for (const PassNote& pass : result.augmented->passes) labels.push_back(pass.label);
  EXPECT_THAT(labels, testing::ElementsAre("background image", "scene model into the depth buffer",
                                           "synthetic objects", "shadow volumes: source 0",
                                           "subtract source 0", "shadow volumes: source 1",
                                           "subtract source 1", "shadow volumes: source 2",
                                           "subtract source 2"));
  EXPECT_EQ(result.augmented->steps.size(), labels.size());
}

TEST_F(DifferentialSession, WithoutALitSceneSaysWhatIsMissing) {
  try {
    run(scene("[differential]\npasses = 10\n"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("[differential].lit_scene: missing"));
  }
  std::ofstream(folder_.path() / "other.lit") << "{}";
  try {
    run(scene("[differential]\nlit_scene = \"other.lit\"\n"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("other.lit"));
  }
}

TEST_F(DifferentialSession, AMethodOfVolumesOnTheCommandLineNeedsLightsNotTheLitScene) {
  const SessionResult result = run(scene("[differential]\nlit_scene = \"room.lit\"\n"),
                                   {.method = pipeline::VolumeMethod::automatic});
  EXPECT_FALSE(result.differential);
}

TEST_F(DifferentialSession, RefusesWrongKeysInOneLine) {
  const std::string file = "[differential]\nlit_scene = \"room.lit\"\n";
  EXPECT_THAT(error_of(file + "passes = 0\n"), HasSubstr("[differential].passes"));
  EXPECT_THAT(error_of(file + "passes = 5\nbudget_ms = 16\n"), HasSubstr("budget_ms: together"));
  EXPECT_THAT(error_of(file + "precision = \"exact\"\n"), HasSubstr("'exact' is not one of bytes"));
  EXPECT_THAT(error_of(file + "mask = \"volumes\"\nmap_size = 64\n"), HasSubstr("map_size"));
  EXPECT_THAT(error_of(file + "power_share = 1.5\n"), HasSubstr("power_share"));
  EXPECT_THAT(error_of(file + "colour = 1\n"), HasSubstr("colour"));
  EXPECT_THAT(error_of("[differential]\nlit_scene = \"no.lit\"\n"), HasSubstr("no.lit"));
}

}  // namespace
}  // namespace gnomon::ar
