// The sweeps of gnomon stability. Oracles: Embree rays, by which every sweep counts; answers that
// are known (a count that wraps, an eye in a shadow); and the same run again.
#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/study/generated_sweeps.h"
#include "apps/study/part_file.h"
#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {
namespace {

using testing::SizeIs;

std::size_t place_of(const std::vector<std::string>& all, const std::string& one) {
  const auto at = std::ranges::find(all, one);
  if (at == all.end()) throw std::invalid_argument("a sweep has no " + one);
  return static_cast<std::size_t>(at - all.begin());
}

Sweep& named(const Sweeps& sweeps, const std::string& name) {
  for (const auto& sweep : sweeps)
    if (sweep->text().name == name) return *sweep;
  throw std::invalid_argument("there is no sweep " + name);
}

/// The share of one method at one value, of one input.
class Shares {
 public:
  Shares(const std::string& sweep, const std::string& value, std::size_t input)
      : sweeps_(generated_sweeps(2)),
        sweep_(named(sweeps_, sweep)),
        outcomes_(sweep_.run(place_of(sweep_.values(), value), input)) {}
  double of(const std::string& method) const {
    return outcomes_[place_of(sweep_.methods(), method)].share();
  }

 private:
  Sweeps sweeps_;
  Sweep& sweep_;
  std::vector<Outcome> outcomes_;
};

/// Pixels at edges, where rays and rasters round differently, are fewer.
constexpr double kEdges = 0.001;

TEST(Sweeps, HaveUniquePlainNamesAndValues) {
  std::set<std::string> names;
  for (const auto& sweep : generated_sweeps(1)) {
    const SweepText text = sweep->text();
    EXPECT_TRUE(is_plain_name(text.name)) << text.name;
    EXPECT_TRUE(names.insert(text.name).second) << text.name;
    for (const std::string& said :
         {text.title, text.explanation, text.parameter, text.measure, text.oracle})
      EXPECT_NE(said, "") << text.name;
    const std::vector<std::string> values = sweep->values(), methods = sweep->methods();
    EXPECT_THAT(std::set<std::string>(values.begin(), values.end()), SizeIs(values.size()));
    EXPECT_THAT(std::set<std::string>(methods.begin(), methods.end()), SizeIs(methods.size()));
    EXPECT_GT(sweep->inputs(), 0u);
  }
}

TEST(Sweeps, LeaveFiniteBuffersAtTheirEnds) {
  for (const auto& sweep : generated_sweeps(2)) {
    for (const std::size_t value : {std::size_t{0}, sweep->values().size() - 1}) {
      const std::vector<Outcome> outcomes = sweep->run(value, 0);
      ASSERT_THAT(outcomes, SizeIs(sweep->methods().size()));
      for (const Outcome& outcome : outcomes) {
        EXPECT_EQ(outcome.not_finite, 0u) << sweep->text().name;
        EXPECT_GT(outcome.of, 0.0) << sweep->text().name;
      }
    }
  }
}

TEST(Sweeps, BeginHarmless) {
  for (const auto& sweep : generated_sweeps(2))
    for (const Outcome& outcome : sweep->run(0, 1))
      EXPECT_LT(outcome.share(), kGivenUp) << sweep->text().name;
}

TEST(Sweeps, AreTheSameForOneThreadAndTwo) {
  const Sweeps one = generated_sweeps(1), two = generated_sweeps(2);
  for (const char* name : {"camera-in-volume", "mesh-torn", "overlaps", "map-size"}) {
    Sweep &a = named(one, name), &b = named(two, name);
    EXPECT_EQ(a.run(1, 1), b.run(1, 1)) << name;
  }
}

TEST(CameraSweeps, ZPassGivesUpInsideAVolumeAndZFailDoesNot) {
  const Shares inside("camera-in-volume", "0.80", 3);
  EXPECT_GT(inside.of("z-pass"), 0.9);
  EXPECT_LT(inside.of("z-fail"), kEdges);
  EXPECT_LT(inside.of("automatic volumes"), kEdges);
  EXPECT_LT(inside.of("alias-free map"), kEdges);
}

TEST(CameraSweeps, ANearPlaneThatCutsAVolumeHarmsNoMethod) {
  const Shares cut("near-plane", "1", 0);
  for (const char* method : {"z-pass", "z-fail", "automatic volumes"})
    EXPECT_LT(cut.of(method), kEdges) << method;
}

// Many casters are counted in batches; one mesh, whose volume is counted at once, may still wrap.
TEST(CountSweeps, AnyNumberOfCastersIsRightAndOneMeshLosesTheShadowOf256Parts) {
  for (const char* sweep : {"overlaps", "overlaps-in-mesh"}) {
    const Shares most(sweep, "255", 0), wrapped(sweep, "256", 0);
    for (const char* method : {"z-pass", "z-fail", "z-fail, single-sided"}) {
      EXPECT_LT(most.of(method), kEdges) << sweep << ", " << method;
      if (sweep == std::string("overlaps"))
        EXPECT_LT(wrapped.of(method), kEdges) << method;
      else
        EXPECT_GT(wrapped.of(method), 0.05) << method;
    }
    EXPECT_LT(wrapped.of("z-pass, saturating"), kEdges) << sweep;
    EXPECT_LT(wrapped.of("alias-free map"), kEdges) << sweep;
  }
}

TEST(LightSweeps, ALampInACornerAnEdgeOrAFaceLeavesFiniteBuffers) {
  std::vector<ShadowSetting> settings = charted_settings();
  for (const auto geometry :
       {pipeline::VolumeGeometry::silhouettes, pipeline::VolumeGeometry::degenerate_quads}) {
    ShadowSetting& radius = settings.emplace_back(volumes("radius", pipeline::VolumeMethod::zfail));
    radius.geometry = geometry;
    radius.extrusion = {pipeline::Extrusion::Kind::radius, 5.0f};
  }
  for (const glm::vec3& at : {glm::vec3(0.5f, 1.25f, 0.375f), glm::vec3(0.5f, 1.25f, 0.0f),
                              glm::vec3(0.25f, 1.25f, 0.125f)}) {
    pipeline::Scene scene = ground_under(glm::vec4(at, 1.0f));
    add_object(scene, "box", pipeline::model_of(pipeline::box_mesh({0.5f, 0.25f, 0.375f})),
               pipeline::placed({0.0f, 1.0f, 0.0f}));
    ShadowTrial trial({"", scene, look_from_side(0, {0.0f, 0.7f, 0.0f}, 4.0f)}, 2);
    for (const ShadowSetting& setting : settings)
      EXPECT_EQ(trial.measure(setting).not_finite, 0u) << setting.name;
  }
}

TEST(MeshSweeps, OnlyVolumesForClosedManifoldsMindFlippedTriangles) {
  const Shares flipped("mesh-flipped", "100", 0);
  EXPECT_GT(flipped.of("z-fail, closed manifolds only"), kGivenUp);
  EXPECT_LT(flipped.of("z-fail"), kEdges);
  EXPECT_LT(flipped.of("alias-free map"), kEdges);
}

TEST(LengthSweeps, AVolumeTooShortForTheGroundLosesItsShadow) {
  const Shares too_short("volume-radius", "0.5", 0);
  EXPECT_GT(too_short.of("z-fail, radius"), 0.05);
  EXPECT_LT(too_short.of("z-fail, as far as needed"), kEdges);
}

TEST(TrialSweep, CountsWhatAContractRefusesAsWhollyWrong) {
  TrialSweep::Plan plan;
  plan.values = {"1"};
  plan.settings = {volumes("z-fail", pipeline::VolumeMethod::zfail), map("near plane at 0", 64)};
  plan.settings[1].map.near_far_m = {0.0f, 9.0f};
  plan.view = [](std::size_t, std::size_t input) {
    return View{"", box_under_lamp(), look_from_side(input, {0.0f, 0.5f, 0.0f}, 4.0f)};
  };
  const std::vector<Outcome> outcomes = TrialSweep(std::move(plan), 1).run(0, 0);
  EXPECT_LT(outcomes[0].share(), kEdges);
  EXPECT_EQ(outcomes[1].wrong, outcomes[0].of);
}

TEST(RandomNumbers, AreTheGeneratorsOwnWords) {
  // The first word of std::mt19937 with its default seed is 3499211612 (as the standard's 10000th,
  // 4123659995, pins the generator).
  EXPECT_EQ(RandomNumbers(5489).below(1u << 31), 3499211612u / 2);
  const std::vector<std::size_t> some = RandomNumbers(1).some_of(10, 4);
  EXPECT_THAT(std::set<std::size_t>(some.begin(), some.end()), SizeIs(4));
  EXPECT_LT(*std::ranges::max_element(some), 10u);
  EXPECT_THAT(RandomNumbers(1).some_of(3, 99), SizeIs(3));
}

}  // namespace
}  // namespace gnomon::apps::study
