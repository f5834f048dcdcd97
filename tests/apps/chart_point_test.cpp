// Points of a chart as files. Oracles: what was written; the documented contract.
#include "apps/study/chart_point.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/study/chart_page.h"
#include "apps/study/chart_plot.h"
#include "apps/study/part_file.h"
#include "ar/error.h"
#include "tests/ar/temporary_folder.h"

namespace gnomon::apps::study {
namespace {

using testing::HasSubstr;
using testing::Not;

ChartPoint point(std::size_t job, std::string method, double ms, double error) {
  return {.job = job,
          .scene = "scene " + std::to_string(job),
          .family = "maps",
          .method = std::move(method),
          .oracle = "rays",
          .times = {3, ms, 0.5 * ms, 2.0 * ms},
          .errors = {{"wrong, %", error}, {"another", 0.125}}};
}

ChartPart whole_run() {
  return {.jobs = 3,
          .scenes = {"scene 0", "scene 1", "scene 2"},
          .frames = 3,
          .done = {0, 1, 2},
          .points = {point(0, "a, \"quoted\"", 1.0, 0.1), point(0, "b", 2.0, 0.05),
                     point(1, "a", 1.0, 0.0), point(2, "a", 4.0, 1e-9)}};
}

/// The part of the run.
ChartPart part_of(const ChartPart& whole, const Shard& shard) {
  ChartPart part = whole;
  part.shard = shard;
  part.done.clear();
  part.points.clear();
  for (const std::size_t job : whole.done)
    if (shard.has(job)) part.done.push_back(job);
  for (const ChartPoint& at : whole.points)
    if (shard.has(at.job)) part.points.push_back(at);
  return part;
}

std::string refusal(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
  try {
    read_chart_part(file);
  } catch (const ar::InputError& error) {
    return error.what();
  }
  return "taken";
}

TEST(ChartPart, PartsPutTogetherAreTheWholeRun) {
  const ar::TemporaryFolder folder;
  std::vector<ChartPart> parts;
  for (const std::size_t number : {2, 1}) {
    const auto file = part_file(folder.path(), "chart", {number, 2});
    write_chart_part(file, part_of(whole_run(), {number, 2}));
    parts.push_back(read_chart_part(file));
  }
  EXPECT_EQ(merge_chart_parts(parts), whole_run());
  parts[1].scenes[2] = "another";
  EXPECT_THROW(merge_chart_parts(parts), ar::InputError);
  parts.pop_back();
  EXPECT_THROW(merge_chart_parts(parts), ar::InputError);
}

TEST(ChartPart, FilesThatAreNoneAreRefusedInOneLine) {
  const ar::TemporaryFolder folder;
  const auto file = folder.path() / "chart.json";
  const std::string head =
      R"({"format":"gnomon-chart 1","shard":[1,1],"jobs":1,"scenes":["s"],"frames":0,"done":[0],"points":[)";
  const std::string point =
      R"({"job":0,"scene":"s","family":"f","method":"m","oracle":"o","errors":[["e",1]])";
  EXPECT_EQ(refusal(file, head + point + "}]}"), "taken");
  for (
      const std::string& text : std::vector<std::string>{
          "", "{", "[]", std::string(R"({"format":"gnomon-chart 9"})"), head + "{}]}",
          head + point + R"(,"picture":"../../etc/passwd"}]})",
          R"({"format":"gnomon-chart 1","shard":[0,0],"jobs":1,"scenes":[],"frames":0,"done":[0],"points":[]})",
          R"({"format":"gnomon-chart 1","shard":[1,1],"jobs":1e300,"scenes":[],"frames":0,"done":[0],"points":[]})",
          R"({"format":"gnomon-chart 1","shard":[1,1],"jobs":1,"scenes":[],"frames":-1,"done":[0],"points":[]})",
          R"({"format":"gnomon-chart 1","shard":[1,2],"jobs":2,"scenes":[],"frames":0,"done":[1],"points":[]})",
          head + R"({"job":7,"scene":"s","family":"f","method":"m","oracle":"o","errors":[]}]})",
          head +
              R"({"job":0,"scene":"s","family":"f","method":"m","oracle":"o","errors":[["e",-1]]}]})",
          head + R"({"job":0,"scene":1,"family":"f","method":"m","oracle":"o","errors":[]}]})"}) {
    const std::string what = refusal(file, text);
    EXPECT_THAT(what, HasSubstr("chart.json: ")) << text;
    EXPECT_THAT(what, Not(HasSubstr("\n"))) << text;
  }
}

TEST(ChartPart, CsvQuotesWhatHasCommas) {
  EXPECT_THAT(chart_csv(whole_run()),
              HasSubstr("\"scene 0\",\"maps\",\"a, \"\"quoted\"\"\",\"rays\",\"wrong, %\",0.1,1,"));
}

TEST(ParetoFront, HoldsWhatNothingElseBeatsInBoth) {
  const std::vector<ChartPoint> points{point(0, "slow", 9.0, 0.5), point(0, "fast", 1.0, 0.9),
                                       point(0, "right", 5.0, 0.0), point(0, "middle", 2.0, 0.4),
                                       point(0, "as right", 6.0, 0.0)};
  std::vector<const ChartPoint*> all;
  for (const ChartPoint& at : points) all.push_back(&at);
  std::vector<std::string> names;
  for (const ChartPoint* at : pareto_front(all)) names.push_back(at->method);
  EXPECT_THAT(names, testing::ElementsAre("fast", "middle", "right"));
}

TEST(ChartPage, TextOfScenesCannotEndTheScript) {
  ChartPart part = whole_run();
  part.points[0].scene = "</script><script>alert(1)</script>";
  const std::string page = chart_page(part, "");
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("\\u003c/script>"));
}

}  // namespace
}  // namespace gnomon::apps::study
