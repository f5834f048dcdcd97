// Oracle: the contract of docs/capture.md, one broken rule at a time.
#include "ar/capture_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ar/error.h"
#include "temporary_folder.h"

namespace gnomon::ar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kHead = "format = \"gnomon-capture 1\"\ncamera = \"camera.yml\"\n";
const std::string kPhotograph =
    "[photograph]\nfile = \"photo.png\"\nbrackets = \"list.json\"\neye_m = [0, 1, 2]\n"
    "target_m = [0, 0, 0]\n";
const std::string kBall =
    "[probe]\nbrackets = \"list.json\"\ncenter_m = [0, 0.5, 0]\nradius_m = 0.05\n"
    "reflectance = 0.9\neye_m = [0, 0.5, 1]\ntarget_m = [0, 0.5, 0]\n";
const std::string kModel = "[model]\nfile = \"room.glb\"\nleave_out = [\"bulb\"]\n";

class CaptureToml : public testing::Test {
 protected:
  CaptureToml() {
    for (const char* name : {"camera.yml", "photo.png", "list.json", "room.glb", "probe.hdr"})
      std::ofstream(folder_.path() / name) << "x";
  }
  void write(const char* name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
  }
  CaptureFile read(const std::string& text) {
    write("capture.toml", text);
    return read_capture(folder_.path());
  }
  std::string error_of(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
      return e.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
};

TEST_F(CaptureToml, ReadsABallWithItsKeys) {
  const CaptureFile c = read(kHead + "patches = 700\n" + kPhotograph + kBall + kModel);
  EXPECT_EQ(c.patches, 700);
  EXPECT_EQ(c.photograph, folder_.path() / "photo.png");
  EXPECT_FALSE(c.exposure_time_s);
  EXPECT_EQ(glm::dvec3(c.world_from_camera[3]), glm::dvec3(0, 1, 2));
  const auto& probe = std::get<BallProbe>(c.probe);
  EXPECT_EQ(probe.ball.radius_m, 0.05);
  EXPECT_EQ(probe.ball.reflectance, glm::dvec3(0.9));
  EXPECT_THAT(c.leave_out, ElementsAre("bulb"));
  const CaptureFile colored = read(kHead + kPhotograph + "exposure_time_s = 0.25\n" +
                                   "[probe]\nbrackets = \"list.json\"\ncenter_m = [0, 0.5, 0]\n"
                                   "radius_m = 0.05\nreflectance = [0.9, 0.8, 0.7]\n"
                                   "eye_m = [0, 0.5, 1]\ntarget_m = [0, 0.5, 0]\n" +
                                   kModel);
  EXPECT_EQ(std::get<BallProbe>(colored.probe).ball.reflectance, glm::dvec3(0.9, 0.8, 0.7));
  EXPECT_EQ(colored.exposure_time_s, 0.25);
  EXPECT_EQ(colored.patches, 1500);
}

TEST_F(CaptureToml, ReadsABallAndPosesOfTheCaptureSetsForm) {
  const std::string pose =
      "\"world_from_camera_opencv\": [[1,0,0,0],[0,1,0,0],[0,0,1,-1],[0,0,0,1]]";
  write("pose.json", "{" + pose + "}");
  write("ball.json",
        "{\"ball_center\": [0, 0, 0], \"ball_radius\": 0.1, \"ball_reflectance\": 0.92, "
        "\"camera\": {" +
            pose + "}}");
  const CaptureFile c = read(kHead +
                             "[photograph]\nfile = \"photo.png\"\nbrackets = \"list.json\"\n"
                             "pose_file = \"pose.json\"\n[probe]\nbrackets = \"list.json\"\n"
                             "file = \"ball.json\"\n" +
                             kModel);
  EXPECT_EQ(c.world_from_camera[3].z, -1.0);
  EXPECT_EQ(std::get<BallProbe>(c.probe).ball.reflectance.y, 0.92);
}

TEST_F(CaptureToml, ReadsALatlongPicture) {
  const CaptureFile c = read(kHead + kPhotograph +
                             "[probe]\nlatlong = \"probe.hdr\"\ncenter_m = [0, 1, 0]\n"
                             "towards = [2, 0, 0]\nscale = [1, 2, 3]\n" +
                             kModel);
  const auto& probe = std::get<LatlongProbe>(c.probe);
  EXPECT_EQ(probe.towards, glm::dvec3(1, 0, 0));
  EXPECT_EQ(probe.scale, glm::dvec3(1, 2, 3));
}

TEST_F(CaptureToml, ReadsASun) {
  const std::string sun = "[sun]\ndirection = [0, 3, 4]\nirradiance = [2, 1, 0]\n";
  const CaptureFile c = read(kHead + kPhotograph + kBall + sun + "through = [\"pane\"]\n" + kModel);
  ASSERT_TRUE(c.sun);
  EXPECT_EQ(c.sun->direction, glm::dvec3(0.0, 0.6, 0.8));
  EXPECT_EQ(c.sun->irradiance, glm::dvec3(2.0, 1.0, 0.0));
  EXPECT_EQ(c.sun->through, std::vector<std::string>{"pane"});
  EXPECT_FALSE(read(kHead + kPhotograph + kBall + kModel).sun);
  EXPECT_THAT(error_of(kHead + kPhotograph + kBall + "[sun]\n" + kModel),
              HasSubstr("[sun].direction: missing"));
  EXPECT_THAT(error_of(kHead + kPhotograph + kBall + "[sun]\ndirection = [0, 0, 0]\n" + kModel),
              HasSubstr("[sun].direction: has no length"));
  EXPECT_THAT(error_of(kHead + kPhotograph + kBall +
                       "[sun]\ndirection = [0, 1, 0]\nirradiance = [-1, 0, 0]\n" + kModel),
              HasSubstr("[sun].irradiance"));
}

TEST_F(CaptureToml, NamesFileLineAndKeyOfWhatIsWrong) {
  EXPECT_THAT(error_of(kHead + "photo = 1\n"), HasSubstr("capture.toml:3: photo: unknown key"));
  EXPECT_THAT(error_of(kHead + kPhotograph + "time = 1\n" + kBall + kModel),
              HasSubstr("capture.toml:8: [photograph].time: unknown key"));
  EXPECT_THAT(error_of(kHead + kPhotograph + kBall + "latlng = 1\n" + kModel),
              HasSubstr("[probe].latlng: unknown key"));
  EXPECT_THAT(error_of(kHead + kPhotograph + kBall), HasSubstr("model: missing: write [model]"));
  EXPECT_THAT(error_of(kHead + kBall + kModel), HasSubstr("photograph: missing"));
  EXPECT_THAT(error_of(kHead + "patches = 0\n" + kPhotograph + kBall + kModel),
              HasSubstr("patches: 0 is not within 1 to 8192"));
  EXPECT_THAT(error_of("format = \"gnomon-capture 2\"\n"), HasSubstr("is not read (accepted"));
  EXPECT_THAT(error_of("camera = 1\n"), HasSubstr("format: missing"));
  EXPECT_THAT(error_of("format = \n"), HasSubstr("capture.toml:1:"));
  EXPECT_THAT(error_of("format = \"gnomon-capture 1\"\ncamera = \"none.yml\"\n"),
              HasSubstr("camera: no such file"));
}

TEST_F(CaptureToml, RefusesPosesThatAreNoneOrTwo) {
  const std::string start =
      kHead + "[photograph]\nfile = \"photo.png\"\nbrackets = \"list.json\"\n";
  EXPECT_THAT(error_of(start + kBall + kModel),
              HasSubstr("[photograph].world_from_camera: missing"));
  EXPECT_THAT(error_of(start + "pose_file = \"list.json\"\neye_m = [0, 0, 0]\n" + kBall + kModel),
              HasSubstr("more than one pose"));
  EXPECT_THAT(error_of(start + "axes = \"opengl\"\neye_m = [0, 0, 0]\ntarget_m = [1, 0, 0]\n" +
                       kBall + kModel),
              HasSubstr("axes: without world_from_camera"));
  write("pose.json", "{\"world_from_camera_opencv\": [[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}");
  EXPECT_THAT(
      error_of(start + "pose_file = \"pose.json\"\n" + kBall + kModel),
      HasSubstr("pose.json:1: world_from_camera_opencv: is not a rotation and translation"));
  write("pose.json", "{\"world_from_camera_opencv\": [[1,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}");
  EXPECT_THAT(error_of(start + "pose_file = \"pose.json\"\n" + kBall + kModel),
              HasSubstr("expected 4 rows of 4 numbers"));
}

TEST_F(CaptureToml, RefusesABallThatIsNone) {
  const auto ball = [&](const std::string& keys) {
    return error_of(kHead + kPhotograph +
                    "[probe]\nbrackets = \"list.json\"\neye_m = [0, 0.5, 1]\n"
                    "target_m = [0, 0.5, 0]\n" +
                    keys + kModel);
  };
  EXPECT_THAT(ball("center_m = [0, 0.5, 0]\nradius_m = 2\nreflectance = 1\n"),
              HasSubstr("inside of its radius 2 m"));
  EXPECT_THAT(ball("center_m = [0, 0.5, 0]\nradius_m = -1\nreflectance = 1\n"),
              HasSubstr("radius_m: -1 is not within"));
  EXPECT_THAT(ball("center_m = [0, 0.5, 0]\nradius_m = 0.1\nreflectance = 0\n"),
              HasSubstr("reflectance: 0 is not within 0.01 to 1"));
  EXPECT_THAT(ball("center_m = [0, 0.5, 0]\nradius_m = 0.1\nreflectance = [1, 1]\n"),
              HasSubstr("reflectance"));
  EXPECT_THAT(ball("center_m = [0, 0.5, nan]\nradius_m = 0.1\nreflectance = 1\n"),
              HasSubstr("center_m: nan is not finite"));
  EXPECT_THAT(ball("radius_m = 0.1\nreflectance = 1\n"), HasSubstr("[probe].center_m: missing"));
  EXPECT_THAT(error_of(kHead + kPhotograph + "[probe]\nlatlong = \"probe.hdr\"\n" + kModel),
              HasSubstr("[probe].center_m: missing"));
  EXPECT_THAT(error_of(kHead + kPhotograph +
                       "[probe]\nlatlong = \"probe.hdr\"\ncenter_m = [0, 0, 0]\n"
                       "towards = [0, 1, 0]\n" +
                       kModel),
              HasSubstr("towards: is not horizontal"));
}

TEST_F(CaptureToml, AFolderWithoutItIsNamed) {
  try {
    read_capture(folder_.path() / "none");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("none: no folder of this name"));
  }
}

}  // namespace
}  // namespace gnomon::ar
