// gnomon replay and gnomon golden as a person runs them. Oracles: golden/manifest.json, and the
// documented contract.
#include <nlohmann/json.hpp>

#include "ar/frame_file.h"
#include "program.h"
#include "raster/isa.h"

namespace gnomon {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const fs::path kGolden = GNOMON_SOURCE_DIR "/golden";
const std::string kFrame = kGolden / "frames/shadow-map-linear.frame";

json expected_buffers(const std::string& scene) {
  return json::parse(text_of(kGolden / "manifest.json"))["scenes"][scene]["buffers"];
}

class Replay : public Program {};

class Golden : public Program {
 protected:
  /// A folder of one scene, to be damaged.
  std::string small_folder() const {
    const std::string name = "state-depth-clamp";
    fs::create_directories(file("golden") + "/frames");
    fs::copy_file(kGolden / "frames" / (name + ".frame"),
                  file("golden") + "/frames/" + name + ".frame",
                  fs::copy_options::overwrite_existing);
    json manifest = json::parse(text_of(kGolden / "manifest.json"));
    manifest["scenes"] = {{name, manifest["scenes"][name]}};
    std::ofstream(file("golden") + "/manifest.json") << manifest.dump();
    return file("golden");
  }
};

TEST_F(Replay, PrintsPassesLabelsAndTheManifestsHashes) {
  for (const std::vector<std::string>& variant :
       {std::vector<std::string>{}, {"--isa", "scalar", "--threads", "1"}, {"--threads", "7"}}) {
    std::vector<std::string> arguments{"replay", kFrame, "--json"};
    arguments.insert(arguments.end(), variant.begin(), variant.end());
    const Outcome got = run(arguments);
    ASSERT_EQ(got.status, 0) << got.err;
    const json line = json::parse(got.out);
    EXPECT_EQ(line["buffers"], expected_buffers("shadow-map-linear"));
    EXPECT_EQ(line["passes"][0]["label"], "shadow map: depth from the lamp");
    EXPECT_EQ(line["passes"][0]["size"], json({48, 40}));
    EXPECT_EQ(line["passes"][2]["commands"].size(), 4u);
  }
  const Outcome text = run({"replay", kFrame});
  EXPECT_THAT(text.out, HasSubstr("3 passes, 12 commands, 12 executed"));
  EXPECT_THAT(text.out,
              HasSubstr("depth d16 48x40 " +
                        expected_buffers("shadow-map-linear")[0]["hash"].get<std::string>()));
}

TEST_F(Replay, StopsAfterTheCommandsAskedFor) {  // oracle: the scene that does the same
  const std::size_t commands =
      json::parse(text_of(kGolden / "manifest.json"))["scenes"]["desk-04-counts"]["commands"];
  const Outcome got = run({"replay", kGolden / "frames/desk-04-automatic.frame", "--commands",
                           std::to_string(commands), "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  EXPECT_EQ(json::parse(got.out)["buffers"], expected_buffers("desk-04-counts"));
  EXPECT_EQ(json::parse(got.out)["executed"], commands);
}

TEST_F(Replay, WritesAPictureOfEveryBuffer) {
  ASSERT_EQ(run({"replay", kFrame, "--out", file("out")}).status, 0);
  const ar::Image map = ar::read_image(file("out") + "/00_depth.png");
  EXPECT_EQ(map.width, 48);
  EXPECT_EQ(map.height, 40);
  EXPECT_EQ(ar::read_image(file("out") + "/02_color.png").width, 130);
  EXPECT_GT(ar::read_image(file("out") + "/04_stencil.png").width, 130);  // with its legend
}

TEST_F(Replay, RefusesBadInputInOneLine) {
  expect_one_line_error(run({"replay", file("none.frame")}), "none.frame");
  std::ofstream(file("cut.frame"), std::ios::binary) << text_of(kFrame).substr(0, 1000);
  expect_one_line_error(run({"replay", file("cut.frame")}), "cut.frame: byte ");
  std::ofstream(file("text.frame")) << "no frame at all, but text";
  expect_one_line_error(run({"replay", file("text.frame")}), "text.frame: byte 0: ");
  expect_one_line_error(run({"replay", kFrame, "--isa", "mmx"}),
                        "there is no 'mmx'; it can be best, scalar");
  const auto available = raster::available_isas();
  if (std::ranges::count(available, raster::Isa::neon) == 0)
    expect_one_line_error(run({"replay", kFrame, "--isa", "neon"}), "has no neon; it can be best");
}

TEST_F(Replay, AFrameFileComesBackAndAFailedWriteLeavesNothing) {  // oracle: the golden file
  const raster::RecordedFrame frame = ar::read_frame(kFrame);
  ar::write_frame(file("again.frame"), raster::encode_frame(frame.frame));
  EXPECT_EQ(text_of(file("again.frame")), text_of(kFrame));
  EXPECT_ANY_THROW(ar::write_frame(file("no/such/again.frame"), {}));
  EXPECT_FALSE(fs::exists(file("no")));
}

TEST_F(Replay, AStillPicturesFrameIsSavedAndReplays) {  // oracle: the command that drew it
  const std::string desk = GNOMON_SOURCE_DIR "/examples/desk/";
  const Outcome drawn =
      run({"ar", desk + "01_torus_on_house.toml", "--image", desk + "background.png", "--out",
           file("out"), "--samples", "1", "--json", "--save-frame", file("desk.frame")});
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  const Outcome got = run({"replay", file("desk.frame"), "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  const json passes = json::parse(drawn.out)["passes"], replayed = json::parse(got.out)["passes"];
  ASSERT_EQ(passes.size(), replayed.size());
  for (std::size_t i = 0; i < passes.size(); ++i) {
    EXPECT_EQ(passes[i]["label"], replayed[i]["label"]);
    EXPECT_EQ(passes[i]["commands"], replayed[i]["commands"].size());
  }
}

TEST_F(Golden, VerifiesEveryScene) {
  const Outcome got = run({"golden", "--verify", "--json"});
  ASSERT_EQ(got.status, 0) << got.out << got.err;
  const json line = json::parse(got.out);
  const std::size_t scenes = json::parse(text_of(kGolden / "manifest.json"))["scenes"].size();
  EXPECT_EQ(line["scenes"].size(), scenes);
  EXPECT_EQ(line["runs"], scenes);
  EXPECT_EQ(line["differing"], 0);
  EXPECT_EQ(got.err, "");  // no progress: this is no terminal
}

TEST_F(Golden, RunsEveryVariantOfThisMachine) {
  const Outcome got = run({"golden", "--verify", "--all-variants", "--golden", small_folder()});
  EXPECT_EQ(got.status, 0) << got.err;
  const std::size_t variants = 5 * raster::available_isas().size();
  EXPECT_THAT(got.out, HasSubstr("1 scenes, " + std::to_string(variants) + " variants, " +
                                 std::to_string(variants) + " runs, 0 differing"));
}

TEST_F(Golden, EndsWithOneWhereAByteDiffersOrAFileIsMissing) {
  const std::string folder = small_folder();
  const std::string frame = folder + "/frames/state-depth-clamp.frame";
  std::string bytes = text_of(frame);
  // The first clear's colour: grey 0.5 gets a red of 0.125.
  const std::size_t grey = bytes.find(std::string("\1\0\0\0\x3f\0\0\0\x3f", 9));
  ASSERT_NE(grey, std::string::npos);
  bytes[grey + 4] = 0x3e;
  std::ofstream(frame, std::ios::binary) << bytes;
  Outcome got = run({"golden", "--verify", "--golden", folder, "--isa", "scalar"});
  EXPECT_EQ(got.status, 1);
  EXPECT_THAT(got.out, HasSubstr("differs in 1 of 1 runs"));
  EXPECT_THAT(got.out, HasSubstr("scalar on all threads: color rgba8 130x97"));
  EXPECT_THAT(got.err, HasSubstr("1 of 1 runs differ"));
  fs::resize_file(frame, 500);
  got = run({"golden", "--verify", "--golden", folder});
  EXPECT_EQ(got.status, 1);
  EXPECT_THAT(got.out, HasSubstr("state-depth-clamp.frame: byte "));
  fs::remove(frame);
  got = run({"golden", "--verify", "--golden", folder, "--json"});
  EXPECT_EQ(got.status, 1);
  EXPECT_THAT(got.out, HasSubstr("state-depth-clamp.frame: no such file"));
}

TEST_F(Golden, ABrokenManifestIsOneLine) {
  const std::string folder = small_folder();
  std::ofstream(folder + "/manifest.json") << "{\"format\":\n";
  expect_one_line_error(run({"golden", "--verify", "--golden", folder}), "manifest.json: ");
  fs::remove(folder + "/manifest.json");
  expect_one_line_error(run({"golden", "--verify", "--golden", folder}), "no such file");
  expect_one_line_error(run({"golden"}), "--verify");
  EXPECT_EQ(run({"golden", "--verify", "--all-variants", "--isa", "scalar"}).status, 1);
}

}  // namespace
}  // namespace gnomon
