// Oracle: rows made by hand; the shape of the JSON as docs/performance.md states it.
#include "bench/report.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/goals.h"

namespace gnomon::bench {
namespace {

using testing::HasSubstr;
using testing::UnorderedElementsAre;

Row row(System system, Method method, double ms, Stage stage = Stage::frame) {
  return {.scene = "tori-12",
          .size = {640, 480},
          .threads = 2,
          .method = method,
          .stage = stage,
          .system = system,
          .median_ms = ms,
          .ratio_to_gnomon = {}};
}

std::vector<Row> some_rows() {
  return {row(System::gnomon, Method::zpass, 4.0),     row(System::gnomon, Method::zfail, 5.0),
          row(System::gnomon, Method::automatic, 2.0), row(System::llvmpipe, Method::zpass, 20.0),
          row(System::llvmpipe, Method::zfail, 30.0),  row(System::embree, Method::rays, 8.0)};
}

double ratio(const std::vector<Row>& rows, System system, Method method) {
  for (const Row& candidate : rows) {
    if (candidate.system == system && candidate.method == method) {
      return candidate.ratio_to_gnomon.value_or(-1.0);
    }
  }
  return -2.0;
}

TEST(Ratio, IsToTheSameMethodAndOfRaysToTheAutomaticOne) {
  std::vector<Row> rows = some_rows();
  complete(rows);
  EXPECT_EQ(ratio(rows, System::gnomon, Method::zpass), 1.0);
  EXPECT_EQ(ratio(rows, System::llvmpipe, Method::zpass), 5.0);
  EXPECT_EQ(ratio(rows, System::llvmpipe, Method::zfail), 6.0);
  EXPECT_EQ(ratio(rows, System::embree, Method::rays), 4.0);
}

TEST(Ratio, OfAPeersAutomaticMethodIsOfItsFasterOne) {
  std::vector<Row> rows = some_rows();
  complete(rows);
  EXPECT_EQ(ratio(rows, System::llvmpipe, Method::automatic), 10.0);
}

TEST(Ratio, IsAbsentWhereGnomonWasNotMeasured) {
  std::vector<Row> rows{row(System::llvmpipe, Method::zpass, 20.0)};
  complete(rows);
  EXPECT_FALSE(rows[0].ratio_to_gnomon.has_value());
}

TEST(Json, HasTheKeysThatReadersRelyOn) {
  Report report{
      .date = "2026-01-31", .processor = "a processor", .commit = "abc", .rows = some_rows()};
  complete(report.rows);
  const nlohmann::json json = to_json(report);
  EXPECT_EQ(json["format"], "gnomon bench");
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["date"], "2026-01-31");
  EXPECT_EQ(json["processor"], "a processor");
  EXPECT_EQ(json["commit"], "abc");
  ASSERT_EQ(json["rows"].size(), report.rows.size());
  for (const auto& entry : json["rows"]) {
    std::vector<std::string> keys;
    for (const auto& item : entry.items()) keys.push_back(item.key());
    EXPECT_THAT(keys, UnorderedElementsAre("scene", "size", "threads", "method", "stage", "system",
                                           "median_ms", "ratio_to_gnomon"));
  }
  EXPECT_EQ(json["rows"][3], nlohmann::json({{"scene", "tori-12"},
                                             {"size", "640x480"},
                                             {"threads", 2},
                                             {"method", "zpass"},
                                             {"stage", "frame"},
                                             {"system", "llvmpipe"},
                                             {"median_ms", 20.0},
                                             {"ratio_to_gnomon", 5.0}}));
}

TEST(Json, SaysNullWhereThereIsNoRatio) {
  const Report report{.rows = {row(System::llvmpipe, Method::zpass, 20.0)}};
  EXPECT_TRUE(to_json(report)["rows"][0]["ratio_to_gnomon"].is_null());
}

TEST(Table, HasALineASystemMethodAndNumberOfThreads) {
  std::vector<Row> rows = some_rows();
  rows.push_back(row(System::llvmpipe, Method::zpass, 12.0, Stage::volumes));
  complete(rows);
  const std::string text = table(rows);
  EXPECT_THAT(text, HasSubstr("tori-12 640x480"));
  EXPECT_THAT(text, HasSubstr("30.00 (6.0x)"));
  EXPECT_THAT(text, HasSubstr("8.00 (4.0x)"));
  // Title, heading and the six series, with llvmpipe's faster one again as auto.
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 1 + 1 + 7);
}

TEST(Goals, AreTheRatiosOfTheRowsThatAreThere) {
  std::vector<Row> rows = some_rows();
  complete(rows);
  const std::vector<Goal> found = goals(rows);
  // Frames of tori-12 on 2 threads: llvmpipe's faster method by 10 and rays by 4; no volumes.
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].what, "tori-12 640x480, frame: llvmpipe auto / gnomon auto");
  EXPECT_EQ(found[0].asked, ">= 8");
  EXPECT_EQ(found[0].measured, "10.00");
  EXPECT_TRUE(found[0].met);
  EXPECT_TRUE(found[1].met);
  rows[2].median_ms = 2.1;
  complete(rows);
  EXPECT_FALSE(goals(rows)[1].met);
}

TEST(Markdown, HasARowAPlaceUnderDateProcessorAndCommit) {
  Report report{
      .date = "2026-01-31", .processor = "a processor", .commit = "abc", .rows = some_rows()};
  complete(report.rows);
  const std::string text = markdown(report);
  EXPECT_THAT(text, HasSubstr("2026-01-31; a processor; commit abc"));
  EXPECT_THAT(text, HasSubstr("| tori-12 | 640x480 | 2 | 2.00 | 4.00 | 5.00 | 20.00 (10.0x) | "
                              "30.00 (6.0x) | - | 8.00 (4.0x) |"));
}

}  // namespace
}  // namespace gnomon::bench
