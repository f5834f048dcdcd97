// A light's shadow in one view against rays. Oracles: closed forms of what is wrong with a picture
// without shadows; the promise that nothing depends on threads.
#include "apps/study/shadow_trial.h"

#include <gtest/gtest.h>

#include "apps/study/generated_views.h"

namespace gnomon::apps::study {
namespace {

View bodies() { return generated_views(160, 120).front(); }

TEST(ShadowTrial, WithoutShadowsWhatIsInShadowIsWrong) {
  ShadowTrial trial(bodies(), 1);
  EXPECT_GT(trial.in_shadow(), 300u);
  EXPECT_GT(trial.tested(), trial.in_shadow());
  const ShadowShot none = trial.measure({.name = "none", .method = pipeline::ShadowMethod::none});
  EXPECT_EQ(none.wrong, static_cast<double>(trial.in_shadow()));
  EXPECT_EQ(none.too_dark, 0.0);
  EXPECT_EQ(none.tested, trial.tested());
}

TEST(ShadowTrial, VolumesAndRaysAreRightAndACoarseMapIsNot) {
  ShadowTrial trial(bodies(), 1);
  EXPECT_EQ(trial.measure_rays().wrong, 0.0);
  const double volumes_wrong =
      trial.measure(volumes("z-fail", pipeline::VolumeMethod::zfail)).wrong;
  const double map_wrong = trial.measure(map("map 32", 32)).wrong;
  EXPECT_LE(volumes_wrong, 2.0);
  EXPECT_GT(map_wrong, 20.0);
}

TEST(ShadowTrial, EverySettingIsFiniteAndTheSameOnAnyThreads) {
  for (const View& view : generated_views(96, 72)) {
    ShadowTrial one(view, 1), three(view, 3);
    EXPECT_EQ(one.tested(), three.tested());
    for (const ShadowSetting& setting : charted_settings()) {
      const ShadowShot a = one.measure(setting), b = three.measure(setting);
      EXPECT_EQ(a.wrong, b.wrong) << view.name << ", " << setting.name;
      EXPECT_EQ(a.not_finite, 0u) << view.name << ", " << setting.name;
      EXPECT_EQ(one.picture().pixels, three.picture().pixels) << view.name << ", " << setting.name;
    }
  }
}

}  // namespace
}  // namespace gnomon::apps::study
