// gnomon capture as a person runs it. Oracle: the documented contract.
#include <nlohmann/json.hpp>

#include "ar/lit_scene_file.h"
#include "program.h"

namespace gnomon {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const fs::path kSoft = GNOMON_SOURCE_DIR "/examples/soft";

class Capture : public Program {};

TEST_F(Capture, WritesALitSceneThatReadsBack) {
  const Outcome got = run({"capture", kSoft, "--out", file("soft.lit"), "--patches", "300",
                           "--samples", "2", "--picture", file("patches.png"), "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  const json line = json::parse(got.out);
  const pipeline::LitScene scene = ar::read_lit_scene(file("soft.lit"));
  EXPECT_EQ(line["patches"], scene.model.patches.size());
  EXPECT_EQ(line["from_photograph"].get<int>() + line["from_probe"].get<int>() +
                line["filled"].get<int>(),
            line["patches"]);
  EXPECT_GT(line["emitting"], 0);
  EXPECT_EQ(scene.probe.width, 256);
  // The patches are the photograph's means: all in all as bright as it is.
  const ar::Image patches = ar::read_image_rgb(file("patches.png"));
  const ar::Image photograph = ar::read_image_rgb(kSoft / "background.png");
  ASSERT_EQ(patches.pixels.size(), photograph.pixels.size());
  double difference = 0.0;
  for (std::size_t i = 0; i < patches.pixels.size(); ++i)
    difference += static_cast<double>(patches.pixels[i]) - photograph.pixels[i];
  EXPECT_NEAR(difference / static_cast<double>(patches.pixels.size()), 0.0, 6.0);
}

TEST_F(Capture, SaysWhatIsWrongInOneLineAndWritesNothing) {
  const std::string out = file("soft.lit");
  expect_one_line_error(run({"capture", file("none"), "--out", out}),
                        "none: no folder of this name");
  expect_one_line_error(run({"capture", kSoft, "--out", file("no/such/folder/a.lit")}),
                        "no folder");
  fs::create_directories(file("bad"));
  std::ofstream(file("bad/capture.toml")) << "format = \"gnomon-capture 1\"\nphoto = 1\n";
  expect_one_line_error(run({"capture", file("bad"), "--out", out}),
                        "capture.toml:2: photo: unknown key");
  EXPECT_FALSE(fs::exists(out));
  expect_one_line_error(run({"capture", file("bad"), "--out", file("bad/capture.toml")}),
                        "unknown key");
}

TEST_F(Capture, DoesNotReplaceItsInputs) {
  fs::copy(kSoft, file("copy"), fs::copy_options::recursive);
  expect_one_line_error(run({"capture", file("copy"), "--out", file("copy/scene.glb")}),
                        "is the input itself");
  EXPECT_EQ(text_of(file("copy/scene.glb")), text_of(kSoft / "scene.glb"));
}

TEST_F(Capture, MisuseOfOptionsIsNamed) {
  for (const auto& [option, value] : {std::pair{"--patches", "0"},
                                      {"--samples", "17"},
                                      {"--visibility-samples", "3"},
                                      {"--threads", "-1"}}) {
    const Outcome got = run({"capture", kSoft, "--out", file("a.lit"), option, value});
    EXPECT_EQ(got.status, 1);
    EXPECT_THAT(got.err, HasSubstr(option));
  }
}

}  // namespace
}  // namespace gnomon
