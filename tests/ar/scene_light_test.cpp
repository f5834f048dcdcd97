// The whole capture. Oracles: lights.json, the true lamps of the rendered room in examples/soft;
// rooms whose light is known.
#include "ar/scene_light.h"

#include <cmath>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "ar/error.h"
#include "ar/image_file.h"
#include "temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path kSoft = GNOMON_SOURCE_DIR "/examples/soft";

const SceneLight& soft() {
  static const SceneLight kLight = find_scene_light(read_capture(kSoft));
  return kLight;
}

struct Emitter {
  double area_m2 = 0.0;
  glm::dvec3 radiance{0.0};
};

Emitter emitter(const pipeline::LitScene& scene, const std::string& name) {
  Emitter e;
  for (std::size_t i = 0; i < scene.model.patches.size(); ++i) {
    const pipeline::Patch& p = scene.model.patches[i];
    if (scene.model.surfaces[p.surface] != name) continue;
    e.area_m2 += p.area_m2;
    e.radiance += p.area_m2 * glm::dvec3(scene.radiance[i]);
  }
  e.radiance /= e.area_m2;
  return e;
}

TEST(SceneLight, FindsTheLampsOfTheRenderedRoom) {
  const auto lights = nlohmann::json::parse(
      std::ifstream(GNOMON_SOURCE_DIR "/tests/data/soft/lights.json"))["lights"];
  const pipeline::LitScene& scene = soft().scene;
  // The unit of radiance is open, a channel at a time: the panel gives it.
  const Emitter panel = emitter(scene, "ceiling_panel");
  for (const auto& light : lights) {
    const Emitter found = emitter(scene, light["name"]);
    for (std::size_t c = 0; c < 3; ++c) {
      const int k = static_cast<int>(c);
      const double unit = lights[0]["radiance"][c].get<double>() / panel.radiance[k];
      const double ratio = found.radiance[k] * unit / light["radiance"][c].get<double>();
      // The lamp is 2 or 3 pixels of the ball's picture, and a centimetre off its place in the
      // model.
      EXPECT_NEAR(ratio, 1.0, light["name"] == "clip_lamp" ? 0.25 : 0.1)
          << light["name"] << " channel " << c;
    }
  }
}

TEST(SceneLight, PhotographAndProbeAgreeAboutWhatBothSee) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(soft().photograph_over_probe[c], 1.0, 0.05);
  EXPECT_GT(soft().from_photograph, 150u);
  EXPECT_GT(soft().from_probe, 300u);
}

TEST(SceneLight, ReflectancesAreOfTheModelsKind) {
  const pipeline::LitScene& scene = soft().scene;
  // scene.glb: base colours are rough averages of the true ones.
  glm::dvec3 sum(0.0);
  double area_m2 = 0.0;
  for (std::size_t i = 0; i < scene.model.patches.size(); ++i) {
    const pipeline::Patch& p = scene.model.patches[i];
    for (int c = 0; c < 3; ++c) {
      ASSERT_GE(scene.reflectance[i][c], 0.0199f);
      ASSERT_LE(scene.reflectance[i][c], 0.9501f);
    }
    if (scene.model.surfaces[p.surface] != "floor") continue;
    sum += p.area_m2 * glm::dvec3(scene.reflectance[i]);
    area_m2 += p.area_m2;
  }
  sum /= area_m2;
  EXPECT_NEAR(sum.x / 0.275, 1.0, 0.25);
  EXPECT_NEAR(sum.y / 0.163, 1.0, 0.25);
  EXPECT_NEAR(sum.z / 0.085, 1.0, 0.25);
}

TEST(SceneLight, TheToneCurveGivesThePhotographItsValues) {
  const pipeline::ToneCurve& tone = soft().scene.tone;
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(tone.value(c, 1.0), 255.0);
    EXPECT_EQ(tone.value(c, 0.0), 0.0);
  }
}

TEST(SceneLight, IsTheSameForAnyNumberOfThreads) {
  const CaptureFile capture = read_capture(kSoft);
  SceneLightOptions options{.patches = 300, .samples = 2, .visibility_samples = 1, .threads = 1};
  const SceneLight one = find_scene_light(capture, options);
  options.threads = 3;
  const SceneLight three = find_scene_light(capture, options);
  EXPECT_EQ(one.scene.radiance, three.scene.radiance);
  EXPECT_EQ(one.scene.reflectance, three.scene.reflectance);
  EXPECT_EQ(one.scene.probe.radiance, three.scene.probe.radiance);
  EXPECT_EQ(one.scene.tone.radiance_from_value, three.scene.tone.radiance_from_value);
}

/// The soft capture with some of it changed.
class ChangedCapture : public testing::Test {
 protected:
  CaptureFile capture_ = read_capture(kSoft);
  SceneLightOptions options_{.patches = 200, .samples = 1, .visibility_samples = 1};

  BallProbe& ball() { return std::get<BallProbe>(capture_.probe); }
  std::string error() const {
    try {
      find_scene_light(capture_, options_);
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "no error";
  }
};

/// A picture in Radiance's format, flat.
void write_hdr(const fs::path& path, int width, int height, const std::vector<glm::vec3>& pixels) {
  std::ofstream out(path, std::ios::binary);
  out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " << height << " +X " << width << "\n";
  for (const glm::vec3& p : pixels) {
    int exponent = 0;
    std::frexp(std::max({p.x, p.y, p.z, 1e-9f}), &exponent);
    for (int c = 0; c < 3; ++c)
      out.put(static_cast<char>(static_cast<int>(std::ldexp(p[c], 8 - exponent))));
    out.put(static_cast<char>(exponent + 128));
  }
}

// The map of directions that the ball gave, in another unit, instead of the ball.
TEST_F(ChangedCapture, ALatlongPictureServesAsProbeInAnyUnit) {
  const TemporaryFolder folder;
  const pipeline::DirectionMap& map = soft().scene.probe;
  const glm::vec3 unit(5.0f, 3.0f, 8.0f);
  std::vector<glm::vec3> pixels = map.radiance;
  for (glm::vec3& p : pixels) p *= unit;
  LatlongProbe probe;
  probe.picture = folder.path() / "probe.hdr";
  probe.center_m = glm::dvec3(map.center);
  probe.towards = {0.0, 0.0, 1.0};
  write_hdr(probe.picture, map.width, map.height, pixels);
  capture_.probe = probe;
  options_.patches = 1500;
  options_.samples = 4;
  const SceneLight light = find_scene_light(capture_, options_);
  for (const char* name : {"ceiling_panel", "window"}) {
    const Emitter found = emitter(light.scene, name), expected = emitter(soft().scene, name);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found.radiance[c] / expected.radiance[c], 1.0, 0.1) << name << " channel " << c;
  }
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(light.photograph_over_probe[c] * static_cast<double>(unit[c]), 1.0, 0.05);
}

TEST_F(ChangedCapture, ABallBesideThePictureIsRefused) {
  ball().ball.center_m = {0.0, 0.5, 3.0};
  EXPECT_THAT(error(), HasSubstr("the ball is not in the picture"));
  ball().ball.center_m = {2.0, 0.5, -0.4};
  EXPECT_THAT(error(), HasSubstr("the ball is not in the picture"));
}

TEST_F(ChangedCapture, ABallPartlyOutsideIsNoted) {
  ball().ball.center_m += glm::dvec3(ball().world_from_camera[0]) * 0.13;
  const SceneLight light = find_scene_light(capture_, options_);
  EXPECT_THAT(light.notes, Contains(HasSubstr("of the ball's outline is outside of the picture")));
}

TEST_F(ChangedCapture, AnotherTimeOfThePhotographIsRefused) {
  capture_.exposure_time_s = 0.5;
  EXPECT_THAT(error(), HasSubstr("from what its brackets say for 0.5 s: is that its time?"));
}

TEST_F(ChangedCapture, PicturesOfAnotherSizeAreRefused) {
  const TemporaryFolder folder;
  capture_.photograph = folder.path() / "small.png";
  write_png(capture_.photograph, {4, 3, 3, std::vector<std::uint8_t>(36, 100)});
  EXPECT_THAT(error(), HasSubstr("pixels, but its brackets have 640 x 480"));
}

TEST_F(ChangedCapture, AnOpenModelIsFilledAndNoted) {
  capture_.leave_out.insert(capture_.leave_out.end(), {"ceiling", "ceiling_panel", "wall_front"});
  const SceneLight light = find_scene_light(capture_, options_);
  EXPECT_THAT(light.notes, Contains(HasSubstr("open: ")));
  for (const glm::vec3& r : light.scene.radiance)
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(r[c]) && r[c] >= 0.0f);
}

TEST_F(ChangedCapture, AModelThatTheProbeDoesNotSeeIsRefused) {
  capture_.model = GNOMON_SOURCE_DIR "/examples/soft/virtual/box_lo.glb";
  capture_.leave_out.clear();
  // Around the ball: all its faces look away from it.
  ball().ball.center_m = {0.0, 0.0, 0.0};
  ball().ball.radius_m = 1e-3;
  ball().world_from_camera[3] = glm::dvec4(-glm::dvec3(ball().world_from_camera[2]) * 0.05, 1.0);
  EXPECT_THAT(error(), HasSubstr("the probe shows no front of any patch"));
}

TEST_F(ChangedCapture, ANameToLeaveOutMustBeThere) {
  capture_.leave_out.push_back("chandelier");
  EXPECT_THAT(error(), HasSubstr("scene.glb: no node 'chandelier' with triangles"));
  capture_.model = GNOMON_SOURCE_DIR "/examples/soft/virtual/box_lo.glb";
  capture_.leave_out.clear();
  capture_.leave_out.push_back("box");
  EXPECT_THAT(error(), testing::AnyOf(HasSubstr("nothing is left of the model"),
                                      HasSubstr("no node 'box'")));
}

}  // namespace
}  // namespace gnomon::ar
