#include "bench/report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace gnomon::bench {

bool same_place(const Row& a, const Row& b) {
  return a.scene == b.scene && a.size == b.size && a.threads == b.threads;
}

const Row* find(const std::vector<Row>& rows, const Row& place, System system, Method method,
                Stage stage) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) {
    return same_place(row, place) && row.system == system && row.method == method &&
           row.stage == stage;
  });
  return found == rows.end() ? nullptr : &*found;
}

namespace {

void add_best_methods(std::vector<Row>& rows) {
  std::vector<Row> best;
  for (const Row& row : rows) {
    if (row.system == System::gnomon || row.method != Method::zpass) continue;
    const Row* zpass = find(rows, row, row.system, Method::zpass, Stage::frame);
    const Row* zfail = find(rows, row, row.system, Method::zfail, Stage::frame);
    if (!zpass || !zfail) continue;
    const Method faster = zpass->median_ms <= zfail->median_ms ? Method::zpass : Method::zfail;
    const Row* taken = find(rows, row, row.system, faster, row.stage);
    if (!taken || find(rows, row, row.system, Method::automatic, row.stage)) continue;
    best.push_back(*taken);
    best.back().method = Method::automatic;
  }
  rows.insert(rows.end(), best.begin(), best.end());
}

}  // namespace

void complete(std::vector<Row>& rows) {
  add_best_methods(rows);
  for (Row& row : rows) {
    const Method method = row.method == Method::rays ? Method::automatic : row.method;
    const Row* own = find(rows, row, System::gnomon, method, row.stage);
    if (own && own->median_ms > 0.0) row.ratio_to_gnomon = row.median_ms / own->median_ms;
  }
}

nlohmann::json to_json(const Report& report) {
  using nlohmann::json;
  json rows = json::array(), agreements = json::array();
  for (const Row& row : report.rows) {
    rows.push_back(
        {{"scene", row.scene},
         {"size", text(row.size)},
         {"threads", row.threads},
         {"method", name(row.method)},
         {"stage", name(row.stage)},
         {"system", name(row.system)},
         {"median_ms", row.median_ms},
         {"ratio_to_gnomon", row.ratio_to_gnomon ? json(*row.ratio_to_gnomon) : json(nullptr)}});
  }
  for (const Agreement& a : report.agreements) {
    agreements.push_back({{"scene", a.scene},
                          {"size", text(a.size)},
                          {"system", name(a.system)},
                          {"method", name(a.method)},
                          {"threads", a.threads},
                          {"differing_pixels", a.differing},
                          {"pixels", a.pixels},
                          {"shadow_share", a.share},
                          {"shadow_share_gnomon", a.gnomon_share}});
  }
  return {{"format", "gnomon bench"},
          {"version", 1},
          {"date", report.date},
          {"processor", report.processor},
          {"commit", report.commit},
          {"load", report.load},
          {"rows", rows},
          {"agreements", agreements},
          {"hashes", report.hashes},
          {"notes", report.notes}};
}

}  // namespace gnomon::bench
