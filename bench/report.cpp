#include "bench/report.h"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace gnomon::bench {
namespace {

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

void add_best_methods(std::vector<Row>& rows) {
  std::vector<Row> best;
  for (const Row& row : rows) {
    if (row.system == System::gnomon || row.method != Method::zpass) continue;
    const Row* zpass = find(rows, row, row.system, Method::zpass, Stage::frame);
    const Row* zfail = find(rows, row, row.system, Method::zfail, Stage::frame);
    if (!zpass || !zfail) continue;
    const Method faster = zpass->median_ms <= zfail->median_ms ? Method::zpass : Method::zfail;
    const Row* taken = find(rows, row, row.system, faster, row.stage);
    if (!taken) continue;
    best.push_back(*taken);
    best.back().method = Method::automatic;
  }
  rows.insert(rows.end(), best.begin(), best.end());
}

/// A line of a table: the stages of one system, method and number of threads.
struct Line {
  const Row* first = nullptr;
  std::array<const Row*, kStages.size()> stages{};
};

std::vector<Line> lines_of(const std::vector<Row>& rows) {
  std::vector<Line> lines;
  for (const Row& row : rows) {
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& other) {
      return same_place(*other.first, row) && other.first->system == row.system &&
             other.first->method == row.method;
    });
    if (line == lines.end()) line = lines.insert(line, Line{&row, {}});
    line->stages[static_cast<std::size_t>(row.stage)] = &row;
  }
  const auto order = [](const Line& line) {
    return std::tuple(line.first->threads, line.first->system, line.first->method);
  };
  // Scenes and sizes stay in the order in which they were measured.
  std::map<std::pair<std::string, int>, std::size_t> places;
  for (const Line& line : lines) {
    places.try_emplace({line.first->scene, line.first->size.width}, places.size());
  }
  std::stable_sort(lines.begin(), lines.end(), [&](const Line& a, const Line& b) {
    const std::size_t place_a = places.at({a.first->scene, a.first->size.width});
    const std::size_t place_b = places.at({b.first->scene, b.first->size.width});
    return std::tuple(place_a, order(a)) < std::tuple(place_b, order(b));
  });
  return lines;
}

std::string cell(const Row* row) {
  if (!row) return "-";
  std::string text = fmt::format("{:.2f}", row->median_ms);
  if (row->system != System::gnomon && row->ratio_to_gnomon) {
    text += fmt::format(" ({:.1f}x)", *row->ratio_to_gnomon);
  }
  return text;
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

std::string table(const std::vector<Row>& rows) {
  std::string out;
  const Row* place = nullptr;
  for (const Line& line : lines_of(rows)) {
    const Row& row = *line.first;
    if (!place || place->scene != row.scene || !(place->size == row.size)) {
      out += fmt::format("\n{} {}\n  {:<9}{:<7}{:>8}", row.scene, text(row.size), "system",
                         "method", "threads");
      for (const Stage stage : kStages) out += fmt::format("{:>18}", name(stage));
      out += "  ms (of gnomon's)\n";
    }
    place = &row;
    out += fmt::format("  {:<9}{:<7}{:>8}", name(row.system), name(row.method), row.threads);
    for (const Row* stage : line.stages) out += fmt::format("{:>18}", cell(stage));
    out += '\n';
  }
  return out;
}

std::string markdown(const Report& report) {
  std::string out = fmt::format(
      "{}; {}; commit {}; load at the start {:.2f}.\n\n"
      "| scene | size | threads | system | method | scene, ms | volumes, ms | shadow, ms | frame, "
      "ms |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      report.date, report.processor, report.commit, report.load);
  for (const Line& line : lines_of(report.rows)) {
    const Row& row = *line.first;
    out += fmt::format("| {} | {} | {} | {} | {} |", row.scene, text(row.size), row.threads,
                       name(row.system), name(row.method));
    for (const Row* stage : line.stages) out += fmt::format(" {} |", cell(stage));
    out += '\n';
  }
  return out;
}

}  // namespace gnomon::bench
