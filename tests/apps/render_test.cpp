// gnomon render as a person runs it. Oracles: rays, by the program's own comparison; the documented
// contract.
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const fs::path kExamples = GNOMON_SOURCE_DIR "/examples/kuehl";

class Render : public Program {};

TEST_F(Render, DrawsBothMethodsOfTheExampleRight) {
  const Outcome got = run({"render", kExamples / "both_methods.toml", "--size", "320x240", "--out",
                           file("out"), "--rays", "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  const json line = json::parse(got.out);
  EXPECT_EQ(line["size"], json({320, 240}));
  ASSERT_EQ(line["rays"].size(), 2u);
  for (const json& light : line["rays"]) {
    EXPECT_GT(light["in_shadow"], 300) << light;
    // Along shadows' edges only.
    EXPECT_LT(light["too_dark"].get<int>() + light["too_light"].get<int>(),
              light["in_shadow"].get<int>() / 10)
        << light;
  }
  std::vector<std::string> labels;
  for (const json& pass : line["passes"]) labels.push_back(pass["label"]);
  EXPECT_THAT(labels, testing::ElementsAre("ambient pass", "shadow volumes: bulb", "lit pass: bulb",
                                           "shadow map: sun", "no volumes: sun", "lit pass: sun"));
  const ar::Image picture = ar::read_image_rgb(file("out/picture.png"));
  EXPECT_EQ(picture.width, 320);
  EXPECT_TRUE(fs::exists(file("out/wrong.png")));
}

TEST_F(Render, ALampAmongThingsGetsSixMaps) {
  const Outcome got = run({"render", kExamples / "lamp.toml", "--size", "320x240", "--out",
                           file("out"), "--rays", "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  const json line = json::parse(got.out);
  int maps = 0;
  for (const json& pass : line["passes"])
    maps += pass["label"].get<std::string>().starts_with("shadow map: lamp ");
  EXPECT_GT(maps, 2);
  const json& light = line["rays"][0];
  EXPECT_GT(light["in_shadow"], 300);
  EXPECT_LT(light["too_dark"].get<int>() + light["too_light"].get<int>(),
            light["in_shadow"].get<int>() / 10);
}

// Oracles: rays to the shadow models, from which pixels at shadows' edges alone differ, and rays to
// what is drawn, from which the reduction does.
TEST_F(Render, ShadowModelsOfTheExampleCastInTheModelsPlace) {
  const Outcome got = run({"render", kExamples / "reduced.toml", "--size", "320x240", "--out",
                           file("out"), "--rays", "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  const json line = json::parse(got.out);
  ASSERT_EQ(line["rays"].size(), 2u);
  for (const json& light : line["rays"]) {
    const int wrong = light["too_dark"].get<int>() + light["too_light"].get<int>();
    EXPECT_GT(light["in_shadow"], 300) << light;
    EXPECT_LT(wrong, 10) << light;
    EXPECT_GT(light["differ_from_drawn"].get<int>(), wrong) << light;
    EXPECT_LT(light["differ_from_drawn"].get<int>(), 500) << light;
  }
  EXPECT_THAT(run({"render", kExamples / "reduced.toml", "--size", "160x120", "--out", file("out"),
                   "--rays"})
                  .out,
              HasSubstr("differ from rays to the models in whose place shadow models cast"));
}

// The frame is the picture: same bytes.
TEST_F(Render, ItsFrameReplaysToThePicture) {
  const Outcome got = run({"render", kExamples / "both_methods.toml", "--size", "160x120", "--out",
                           file("out"), "--steps", "--save-frame", file("scene.frame")});
  ASSERT_EQ(got.status, 0) << got.err;
  EXPECT_THAT(got.out, HasSubstr("6 objects"));
  const Outcome replay = run({"replay", file("scene.frame"), "--out", file("replayed")});
  ASSERT_EQ(replay.status, 0) << replay.err;
  EXPECT_EQ(ar::read_image_rgb(file("out/picture.png")).pixels,
            ar::read_image_rgb(file("replayed/00_color.png")).pixels);
  EXPECT_TRUE(fs::exists(file("out/steps/02_shadow_volumes_bulb_stencil.png")));
}

TEST_F(Render, ModulativeDarkensByAQuad) {
  const Outcome got = run({"render", kExamples / "both_methods.toml", "--size", "160x120", "--out",
                           file("out"), "--method", "modulative", "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  EXPECT_EQ(json::parse(got.out)["passes"].back()["label"], "shadow quad: sun");
}

TEST_F(Render, SaysWhatIsWrong) {
  const std::string scene = kExamples / "lamp.toml";
  expect_one_line_error(run({"render", file("none.toml"), "--out", file("out")}), "none.toml");
  for (const char* size : {"640", "0x480", "640x", "20000x20000", "1x1x1"})
    expect_one_line_error(run({"render", scene, "--out", file("out"), "--size", size}),
                          std::string("--size ") + size + ": not WIDTHxHEIGHT");
  expect_one_line_error(
      run({"render", scene, "--out", file("out"), "--method", "modulative", "--rays"}),
      "--rays goes with --method additive");
  std::ofstream(file("both.toml"))
      << "format = \"gnomon-scene 1\"\n[[object]]\nname = \"a\"\nrole = \"virtual\"\nmodel = \""
      << GNOMON_SOURCE_DIR << "/examples/desk/virtual/torus_lo.glb\"\n"
      << "[[light]]\nname = \"l\"\nposition_m = [1, 1, 1]\n"
      << "[[caster]]\nmethod = \"map\"\n[[caster]]\nnode = \"a\"\nmethod = \"volumes\"\n";
  expect_one_line_error(run({"render", file("both.toml"), "--out", file("out")}),
                        "another shadow node gives a caster another method");
  EXPECT_FALSE(fs::exists(file("out")));
}

}  // namespace
}  // namespace gnomon
