// gnomon ar as a person runs it, on good input and bad. Oracles: the photograph's own bytes, and
// the documented contract.
#include <nlohmann/json.hpp>

#include "ar/video.h"
#include "program.h"

namespace gnomon {
namespace {

using testing::HasSubstr;

const std::string kDesk = GNOMON_SOURCE_DIR "/examples/desk/";
const std::string kScene = kDesk + "01_torus_on_house.toml";
const std::string kPhoto = kDesk + "background.png";

class Ar : public Program {
 protected:
  /// The scene with one piece of text replaced, beside its models' absolute paths.
  std::string changed_scene(const std::string& from, const std::string& to) const {
    std::string text = text_of(kScene);
    const auto replace_all = [&](const std::string& a, const std::string& b) {
      for (std::size_t i = text.find(a); i != std::string::npos; i = text.find(a, i + b.size()))
        text.replace(i, a.size(), b);
    };
    EXPECT_NE(text.find(from), std::string::npos) << from;
    replace_all("\"camera.yml\"", "\"" + kDesk + "camera.yml\"");
    replace_all("\"response.json\"", "\"" + kDesk + "response.json\"");
    replace_all("\"phantoms/", "\"" + kDesk + "phantoms/");
    replace_all("\"virtual/", "\"" + kDesk + "virtual/");
    replace_all("\"scene.glb\"", "\"" + kDesk + "scene.glb\"");
    replace_all(from, to);
    std::ofstream(file("scene.toml")) << text;
    return file("scene.toml");
  }

  void expect_failure(const std::vector<std::string>& arguments, const std::string& part) const {
    expect_one_line_error(run(arguments), part);
    EXPECT_FALSE(fs::exists(file("out"))) << part;
  }
};

}  // namespace

TEST_F(Ar, WritesEveryPictureAndOneLineOfJson) {
  const Outcome got = run({"ar", kScene, "--image", kPhoto, "--out", file("out"), "--samples", "1",
                           "--steps", "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  for (const char* name :
       {"composite", "shadow_mask", "shadow_on_virtual", "object_mask", "stencil_counts"})
    EXPECT_TRUE(fs::exists(file("out") + "/" + name + ".png")) << name;
  const auto line = nlohmann::json::parse(got.out);
  EXPECT_EQ(std::count(got.out.begin(), got.out.end(), '\n'), 1);
  EXPECT_EQ(line["tags"].size(), 6u);
  EXPECT_EQ(line["passes"][0]["label"], "step 1: real scene with the shadows of real objects");
  EXPECT_EQ(line["poses"]["bodies"].size(), 2u);
  EXPECT_GT(line["ms"]["execute"].get<double>(), 0.0);
  std::size_t steps = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(file("out") + "/steps")) ++steps;
  EXPECT_GE(steps, 3u * 8u);
}

TEST_F(Ar, KeepsThePhotographsBytesAwayFromObjectsAndShadows) {
  for (const char* samples : {"1", "3"}) {
    ASSERT_EQ(
        run({"ar", kScene, "--image", kPhoto, "--out", file("out"), "--samples", samples}).status,
        0);
    const ar::Image photo = ar::read_image_rgb(kPhoto);
    const ar::Image composite = ar::read_image_rgb(file("out") + "/composite.png");
    const ar::Image shadow = ar::read_image(file("out") + "/shadow_mask.png");
    const ar::Image object = ar::read_image(file("out") + "/object_mask.png");
    int kept = 0, slivers = 0, changed = 0;
    for (int y = 2; y < photo.height - 2; ++y)
      for (int x = 2; x < photo.width - 2; ++x) {
        bool near = false;
        for (int j = -2; j <= 2; ++j)
          for (int i = -2; i <= 2; ++i)
            near |= shadow.at(x + i, y + j)[0] != 0 || object.at(x + i, y + j)[0] != 0;
        const std::uint8_t *was = photo.at(x, y), *is = composite.at(x, y);
        const bool equal = std::equal(was, was + 3, is);
        changed += !equal;
        if (near) continue;
        kept += equal;
        slivers += !equal;
        // What is left are slivers of shadow over less than half a pixel, which no mask shows.
        ASSERT_TRUE(is[0] <= was[0] && is[1] <= was[1] && is[2] <= was[2]) << x << ' ' << y;
      }
    EXPECT_GT(kept, 250000);
    EXPECT_GT(changed, 5000);
    EXPECT_LT(slivers, kept / 1000);
  }
}

TEST_F(Ar, SameBytesOnOneThreadAndOnMany) {
  for (const char* threads : {"1", "7"})
    ASSERT_EQ(run({"ar", kScene, "--image", kPhoto, "--out", file(threads), "--samples", "2",
                   "--threads", threads})
                  .status,
              0);
  for (const char* name :
       {"composite", "shadow_mask", "shadow_on_virtual", "object_mask", "stencil_counts"})
    EXPECT_EQ(text_of(file("1") + "/" + name + ".png"), text_of(file("7") + "/" + name + ".png"));
}

TEST_F(Ar, BadInputIsOneLineAndWritesNothing) {
  const std::string out = file("out");
  const auto still = [&](const std::string& scene, const std::string& image) {
    return std::vector<std::string>{"ar", scene, "--image", image, "--out", out};
  };
  expect_failure(still(file("none.toml"), kPhoto), "none.toml");
  expect_failure(still(kScene, file("none.png")), "none.png");
  std::ofstream(file("cut.png"), std::ios::binary) << text_of(kPhoto).substr(0, 30000);
  expect_failure(still(kScene, file("cut.png")), "cut.png: truncated");
  expect_failure(still(kScene, write_picture("grey.png", 640, 480, 3, 90)), "grey.png: no pose");
  expect_failure(still(kScene, write_picture("tall.png", 480, 640, 3, 90)), "480");
  expect_failure(still(changed_scene("role = \"virtual\"", "castz = true"), kPhoto), "castz");
  expect_failure(still(changed_scene("tag36h11", "tag99h9"), kPhoto), "tag99h9");
  expect_failure(still(changed_scene("0.997564018", "nan"), kPhoto), "nan");
  expect_failure(still(changed_scene("size_m = 0.08", "size_m = \"big\""), kPhoto), "size_m");
  expect_failure({"ar", kScene, "--video", file("none.avi"), "--out", out}, "none.avi");
  std::ofstream(file("text.avi")) << "no video";
  expect_failure({"ar", kScene, "--video", file("text.avi"), "--out", out}, "text.avi");
  expect_failure({"ar", kScene, "--camera", "63", "--out", out}, "camera 63");
  expect_failure({"ar", kScene, "--out", out}, "exactly one of");
  expect_failure({"ar", kScene, "--image", kPhoto, "--camera", "0", "--out", out},
                 "exactly one of");
  expect_one_line_error(run({"ar", kScene, "--image", kPhoto, "--out", file("cut.png")}),
                        "cut.png");
}

TEST_F(Ar, AVideoFrameWithoutTagsKeepsItsPhotographAndIsCounted) {
  const ar::Image photo = ar::read_image_rgb(kPhoto);
  ar::Image grey = photo;
  std::fill(grey.pixels.begin(), grey.pixels.end(), std::uint8_t{90});
  {
    // Longer apart than a pose is held.
    ar::VideoWriter writer(file("in.avi"), photo.width, photo.height, 2.0);
    writer.write(photo);
    writer.write(grey);
    writer.write(photo);
    writer.close();
  }
  const Outcome got =
      run({"ar", kScene, "--video", file("in.avi"), "--out", file("out"), "--samples", "1"});
  ASSERT_EQ(got.status, 0) << got.err;
  EXPECT_THAT(got.out, HasSubstr("3 frames: 2 augmented"));
  EXPECT_THAT(got.out, HasSubstr("1 without a pose"));
  EXPECT_EQ(got.err, "");  // no progress bar: this is no terminal
  ar::VideoReader reader = ar::VideoReader::open_file(file("out") + "/composite.avi");
  reader.next();
  const auto middle = reader.next();
  ASSERT_TRUE(middle.has_value());
  // Twice through MJPG: grey stays grey within its rounding.
  for (const std::uint8_t value : middle->image.pixels) ASSERT_NEAR(value, 90, 2);
}

// Oracle: the documented contract. The window is one that no screen shows.
TEST_F(Ar, AVideoIsShownInAWindowWithOrWithoutAFile) {
  {
    const ar::Image photo = ar::read_image_rgb(kPhoto);
    ar::VideoWriter writer(file("in.avi"), photo.width, photo.height, 12.0);
    writer.write(photo);
    writer.write(photo);
    writer.close();
  }
  std::vector<std::string> arguments{"ar",        kScene, "--video", file("in.avi"),
                                     "--samples", "1",    "--show"};
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) unsetenv(name);
  expect_one_line_error(run(arguments), "--show: there is no display");
  setenv("QT_QPA_PLATFORM", "offscreen", 1);
  Outcome got = run(arguments);
  EXPECT_EQ(got.status, 0) << got.err;
  EXPECT_THAT(got.out, HasSubstr("2 frames: 2 augmented"));
  EXPECT_EQ(got.out.find("wrote"), std::string::npos);
  arguments.insert(arguments.end(), {"--out", file("out")});
  got = run(arguments);
  EXPECT_EQ(got.status, 0) << got.err;
  EXPECT_TRUE(fs::exists(file("out") + "/composite.avi"));
  unsetenv("QT_QPA_PLATFORM");
  expect_one_line_error(run({"ar", kScene, "--video", file("in.avi")}), "--out is needed");
  expect_one_line_error(run({"ar", kScene, "--image", kPhoto, "--out", file("out"), "--show"}),
                        "--show goes with");
}

// Oracle: the whole run.
TEST_F(Ar, AVideoDrawnInPartsIsTheWholeOneToTheByte) {
  const ar::Image photo = ar::read_image_rgb(kPhoto);
  {
    ar::VideoWriter writer(file("in.avi"), photo.width, photo.height, 12.0);
    for (int i = 0; i < 5; ++i) {
      // A picture's brightness changes a little, so that each is its own and poses are filtered.
      ar::Image picture = photo;
      for (std::uint8_t& value : picture.pixels)
        value = static_cast<std::uint8_t>(value - value * i / 20);
      writer.write(picture);
    }
    writer.close();
  }
  const auto drawn = [&](const std::string& out, const std::string& more) {
    std::vector<std::string> arguments{"ar",    kScene,    "--video",   file("in.avi"),
                                       "--out", file(out), "--samples", "1"};
    if (more == "--merge")
      arguments.push_back(more);
    else
      arguments.insert(arguments.end(), {"--shard", more});
    return run(arguments);
  };
  ASSERT_EQ(drawn("whole", "1/1").status, 0);
  expect_one_line_error(drawn("parts", "--merge"), "parts");
  ASSERT_EQ(drawn("parts", "2/2").status, 0);
  expect_one_line_error(drawn("parts", "--merge"), "part 1 of 2 is missing");
  ASSERT_EQ(drawn("parts", "1/2").status, 0);
  const Outcome merged = drawn("parts", "--merge");
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(text_of(file("whole/composite.avi")), text_of(file("parts/composite.avi")));
  EXPECT_GT(fs::file_size(file("whole/composite.avi")), 10'000u);
}

}  // namespace gnomon
