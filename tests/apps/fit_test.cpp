// gnomon fit as a person runs it. Oracles: the documented contract; gnomon render and gnomon ar,
// which take what it wrote.
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const fs::path kSource = GNOMON_SOURCE_DIR;
const std::string kScene = kSource / "examples/kuehl/both_methods.toml";
const std::string kDesk = kSource / "examples/desk/01_torus_on_house.toml";

class FitCommand : public Program {};

TEST_F(FitCommand, WritesASceneThatRenderTakes) {
  const Outcome got =
      run({"fit", kScene, "--error", "2px", "--out", file("out"), "--repeat", "1", "--json"});
  ASSERT_EQ(got.status, 0) << got.err;
  EXPECT_EQ(std::count(got.out.begin(), got.out.end(), '\n'), 1);
  const json report = json::parse(got.out);
  EXPECT_EQ(report["format"], "gnomon-fit 1");
  EXPECT_LE(report["error"].get<double>(), 2.0);
  EXPECT_LT(report["after"]["casting_triangles"], report["before"]["casting_triangles"]);
  EXPECT_GT(report["items"].size(), 5u);
  EXPECT_EQ(json::parse(text_of(file("out/report.json"))), report);
  EXPECT_THAT(text_of(file("out/report.md")), HasSubstr("| shadow of 'torus' | reduced |"));
  for (const char* name : {"before.png", "after.png", "difference.png"})
    EXPECT_EQ(ar::read_image_rgb(file(std::string("out/") + name)).width, 640) << name;
  const Outcome again = run({"render", file("out/scene.toml"), "--out", file("again")});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(ar::read_image_rgb(file("again/picture.png")).pixels,
            ar::read_image_rgb(file("out/after.png")).pixels);
  // Nothing stays beside the folder.
  for (const auto& entry : fs::directory_iterator(file("out/..")))
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr(".gnomon-fit"))) << entry;
}

TEST_F(FitCommand, WritesASceneThatArTakes) {
  const std::string photograph = kSource / "examples/desk/background.png";
  const Outcome got = run({"fit", kDesk, "--image", photograph, "--error", "2px", "--out",
                           file("out"), "--repeat", "1"});
  ASSERT_EQ(got.status, 0) << got.err;
  EXPECT_THAT(got.out, HasSubstr("| phantom 'crate' | dropped |"));
  const Outcome again =
      run({"ar", file("out/scene.toml"), "--image", photograph, "--out", file("again")});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(ar::read_image_rgb(file("again/composite.png")).pixels,
            ar::read_image_rgb(file("out/after.png")).pixels);
}

TEST_F(FitCommand, SaysInOneLineWhatIsWrongAndWritesNothing) {
  const std::string small = write_picture("small.png", 64, 48, 3, 100);
  const std::string grey = write_picture("grey.png", 640, 480, 3, 100);
  const std::string soft = kSource / "examples/soft/box.toml";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{kScene, "--error", "1"}, "--error 1: is neither pixels"},
      {{kScene, "--error", "-1px"}, "--error -1px"},
      {{kScene, "--error", "nanpx"}, "--error nanpx"},
      {{kScene, "--error", "1e400px"}, "--error 1e400px"},
      {{kScene, "--error", "17px"}, "up to 16"},
      {{kScene, "--error", "1.5flip"}, "up to 1"},
      {{file("no.toml"), "--error", "1px"}, "no.toml"},
      {{kDesk, "--error", "1px", "--image", file("no.png")}, "no.png"},
      {{kDesk, "--error", "1px", "--image", grey}, "no pose"},
      {{kDesk, "--error", "1px", "--image", grey, "--image", small}, "no pose"},
      {{soft, "--error", "1px"}, "give one"},
      {{soft, "--error", "1px", "--image", grey}, "lit_scene"},
      {{soft, "--error", "1px", "--image", grey, "--lit-scene", grey}, "grey.png"}};
  for (const auto& [arguments, part] : cases) {
    std::vector<std::string> all{"fit"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"--out", file("out"), "--repeat", "1"});
    expect_one_line_error(run(all), part);
    EXPECT_FALSE(fs::exists(file("out"))) << part;
  }
}

// What the scene names lies in the folder that the results go to.
TEST_F(FitCommand, WritesBesideTheModelsOfItsScene) {
  fs::create_directories(file("room"));
  std::string text = text_of(kScene);
  for (const std::string folder : {"../desk/virtual/", "../desk/phantoms/"})
    for (std::size_t at; (at = text.find(folder)) != std::string::npos;)
      text.replace(at, folder.size(), "");
  std::ofstream(file("room/given.toml")) << text;
  for (const char* folder : {"virtual", "phantoms"})
    for (const auto& entry : fs::directory_iterator(kSource / "examples/desk" / folder))
      fs::copy(entry.path(), file("room"));
  const Outcome got = run(
      {"fit", file("room/given.toml"), "--error", "4px", "--out", file("room"), "--repeat", "1"});
  ASSERT_EQ(got.status, 0) << got.err;
  const Outcome again = run({"render", file("room/scene.toml"), "--out", file("again")});
  EXPECT_EQ(again.status, 0) << again.err;
}

TEST_F(FitCommand, RefusesToReplaceItsInput) {
  fs::copy_file(kSource / "examples/kuehl/both_methods.toml", file("scene.toml"));
  std::string text = text_of(file("scene.toml"));
  for (std::size_t at; (at = text.find("\"../desk")) != std::string::npos;)
    text.replace(at, 8, "\"" + (kSource / "examples/desk").string());
  std::ofstream(file("scene.toml")) << text;
  expect_one_line_error(run({"fit", file("scene.toml"), "--error", "1px", "--out", file("")}),
                        "is the input itself");
  EXPECT_EQ(text_of(file("scene.toml")), text);
}

}  // namespace
}  // namespace gnomon
