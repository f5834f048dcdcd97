// The program from its command line to its JSON. Oracle: the agreement of the systems themselves,
// which the program checks before it measures; times are not looked at.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class BenchProgram : public testing::Test {
 protected:
  BenchProgram() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~BenchProgram() override { fs::remove_all(folder_); }

  /// Exit status; what it says on standard error is in `errors_`.
  int run(const std::string& arguments) {
    const fs::path errors = folder_ / "errors";
    const std::string command = "'" GNOMON_BENCH_PROGRAM "' " + arguments + " >'" +
                                (folder_ / "out").string() + "' 2>'" + errors.string() + "'";
    const int status = std::system(command.c_str());
    std::ostringstream text;
    text << std::ifstream(errors).rdbuf();
    errors_ = text.str();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  nlohmann::json json() const { return nlohmann::json::parse(std::ifstream(file_)); }

  static std::set<std::string> values(const nlohmann::json& rows, const char* key) {
    std::set<std::string> out;
    for (const auto& row : rows) out.insert(row[key].get<std::string>());
    return out;
  }

  const fs::path folder_ = fs::path(GNOMON_BUILD_DIR) / "bench_program_test" /
                           testing::UnitTest::GetInstance()->current_test_info()->name();
  const fs::path file_ = folder_ / "bench.json";
  std::string errors_;
};

TEST_F(BenchProgram, AllSystemsDrawTheToriAndTheDeskAlike) {
  ASSERT_EQ(run("--quick --scene tori-12 --scene desk --json '" + file_.string() + "'"), 0)
      << errors_;
  const nlohmann::json report = json();
  EXPECT_EQ(report["format"], "gnomon bench");
  EXPECT_THAT(values(report["rows"], "system"),
              ElementsAre("embree", "gnomon", "llvmpipe", "softpipe"));
  EXPECT_THAT(values(report["rows"], "method"), ElementsAre("auto", "rays", "zfail", "zpass"));
  EXPECT_THAT(values(report["rows"], "stage"), ElementsAre("frame", "scene", "shadow", "volumes"));
  EXPECT_THAT(values(report["rows"], "scene"), ElementsAre("desk", "tori-12"));
  for (const auto& row : report["rows"]) {
    EXPECT_GT(row["median_ms"].get<double>(), 0.0);
    EXPECT_GT(row["ratio_to_gnomon"].get<double>(), 0.0) << row;
  }
  EXPECT_EQ(report["hashes"].size(), 2u);
  // A picture without a shadow would agree with anything.
  for (const auto& agreement : report["agreements"]) {
    EXPECT_GT(agreement["shadow_share_gnomon"].get<double>(), 0.05);
  }
}

TEST_F(BenchProgram, LayersAndMapsAreCountedAlike) {
  ASSERT_EQ(run("--quick --scene layer --scene map --threads 1 --json '" + file_.string() + "'"), 0)
      << errors_;
  EXPECT_THAT(values(json()["rows"], "scene"), ElementsAre("layer-decided", "layer-random", "map"));
  EXPECT_THAT(values(json()["rows"], "stage"), ElementsAre("frame", "scene", "volumes"));
}

TEST_F(BenchProgram, GrowthIsWrittenAsFiguresAndAsAPicture) {
  const fs::path picture = folder_ / "growth.svg";
  ASSERT_EQ(run("growth --rounds 1 --frames 1 --most-triangles 3000 --most-pixels 307200 --json '" +
                file_.string() + "' --svg '" + picture.string() + "'"),
            0)
      << errors_;
  const nlohmann::json growth = json();
  EXPECT_EQ(growth["format"], "gnomon bench growth");
  ASSERT_EQ(growth["by_triangles"].size(), 3u);
  EXPECT_EQ(growth["by_triangles"][0]["system"], "gnomon");
  EXPECT_EQ(growth["by_triangles"][0]["points"].size(), 2u);
  EXPECT_EQ(growth["by_pixels"][0]["points"][0]["pixels"], 307200.0);
  std::ostringstream svg;
  svg << std::ifstream(picture).rdbuf();
  EXPECT_THAT(svg.str(), HasSubstr("gnomon frame, slope"));
  EXPECT_THAT(svg.str(), HasSubstr("</svg>"));
}

TEST_F(BenchProgram, WrongArgumentsAreOneLineAndExitStatusOne) {
  for (const char* arguments :
       {"--scene nothing", "--size 640", "--threads 0", "--system nvidia", "--frames x",
        "--mesh /nowhere.glb --scene meshes --quick", "--json /nowhere/at/all.json --list extra"}) {
    EXPECT_EQ(run(arguments), 1) << arguments;
    EXPECT_THAT(errors_, HasSubstr("gnomon_bench: ")) << arguments;
  }
}

TEST_F(BenchProgram, HelpAndListSucceed) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(run("--list"), 0);
}

}  // namespace
