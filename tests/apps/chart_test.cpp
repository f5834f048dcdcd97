// gnomon chart and gnomon stability as a person runs them. Oracles: the documented contract; a run
// in parts against the whole run.
#include <nlohmann/json.hpp>

#include "program.h"

namespace gnomon {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Chart : public Program {
 protected:
  /// One photograph of the desk, for speed.
  std::string small_study() const {
    const std::string source = GNOMON_SOURCE_DIR;
    const std::string truth = source + "/tests/data/desk/03_tin_on_torus/";
    std::ofstream(file("study.toml"))
        << "format = \"gnomon-study 1\"\n[[photograph]]\n"
        << "name = \"tin\"\nscene = \"" << truth << "true_light.toml\"\nphotograph = \"" << source
        << "/examples/desk/background.png\"\ntruth = \"" << truth << "photo.png\"\nshadow_mask = \""
        << truth << "shadow_mask.png\"\nobject_mask = \"" << truth << "object_mask.png\"\n";
    return file("study.toml");
  }
};

TEST_F(Chart, PartsPutTogetherAreTheWholeRunToTheByte) {
  const std::string study = small_study();
  const std::vector<std::string> common{"chart", study, "--no-generated", "--frames", "0", "--out"};
  const auto with = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = common;
    arguments.push_back(out);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const Outcome whole = with(file("whole"), {});
  ASSERT_EQ(whole.status, 0) << whole.err;
  for (const char* part : {"2/2", "1/2"}) {
    const Outcome got = with(file("parts"), {"--shard", part});
    ASSERT_EQ(got.status, 0) << got.err;
  }
  EXPECT_FALSE(fs::exists(file("parts/chart.html")));
  const Outcome merged = run({"chart", "--merge", "--out", file("parts")});
  ASSERT_EQ(merged.status, 0) << merged.err;
  for (const char* name : {"chart.json", "chart.csv", "chart.html"})
    EXPECT_EQ(text_of(file("whole") + "/" + name), text_of(file("parts") + "/" + name)) << name;
  std::size_t pictures = 0;
  for (const auto& entry : fs::directory_iterator(file("whole/pictures"))) {
    EXPECT_EQ(text_of(entry.path()), text_of(file("parts/pictures") / entry.path().filename()));
    ++pictures;
  }
  EXPECT_GT(pictures, 50u);
}

TEST_F(Chart, TimesAndDrawsASmallChart) {
  const Outcome got =
      run({"chart", small_study(), "--no-generated", "--frames", "1", "--out", file("out")});
  ASSERT_EQ(got.status, 0) << got.err;
  const json whole = json::parse(text_of(file("out/chart.json")));
  EXPECT_EQ(whole["format"], "gnomon-chart 1");
  for (const json& point : whole["points"]) EXPECT_GT(point["ms"]["median"], 0.0) << point;
  const std::string drawing = text_of(file("out/chart.svg"));
  EXPECT_THAT(drawing, HasSubstr("light's shadow"));
  EXPECT_THAT(drawing, HasSubstr("</svg>"));
}

TEST_F(Chart, SaysInOneLineWhatIsWrong) {
  expect_one_line_error(run({"chart", "--out", file("out"), "--shard", "3/2"}), "--shard: '3/2'");
  expect_one_line_error(run({"chart", "--merge", "--out", file("nothing")}), "nothing");
  std::ofstream(file("empty.toml")) << "format = \"gnomon-study 1\"\n";
  expect_one_line_error(run({"chart", file("empty.toml"), "--out", file("out")}), "empty.toml");
  std::ofstream(file("wrong.toml")) << "format = \"gnomon-study 1\"\n[[photograph]]\nname = 3\n";
  expect_one_line_error(run({"chart", file("wrong.toml"), "--out", file("out")}),
                        "wrong.toml:3: [[photograph]].name");
  expect_one_line_error(run({"chart", file("no.toml"), "--out", file("out")}), "no.toml");
  EXPECT_FALSE(fs::exists(file("out")));
}

TEST_F(Chart, StabilityNamesItsSweepsAndRefusesOthers) {
  const Outcome list = run({"stability", "--list"});
  ASSERT_EQ(list.status, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("camera-in-volume"));
  expect_one_line_error(run({"stability", "--out", file("out"), "--only", "nothing"}),
                        "--only nothing");
  expect_one_line_error(run({"stability"}), "--out");
}

}  // namespace
}  // namespace gnomon
