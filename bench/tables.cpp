#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "bench/goals.h"
#include "bench/report.h"

namespace gnomon::bench {
namespace {

/// A line of a table: the stages of one system, method and number of threads.
struct Line {
  const Row* first = nullptr;
  std::array<const Row*, kStages.size()> stages{};
};

std::string place_name(const Row& row) { return row.scene + " " + text(row.size); }

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
  std::map<std::string, std::size_t> places;
  for (const Line& line : lines) places.try_emplace(place_name(*line.first), places.size());
  std::stable_sort(lines.begin(), lines.end(), [&](const Line& a, const Line& b) {
    return std::tuple(places.at(place_name(*a.first)), order(a)) <
           std::tuple(places.at(place_name(*b.first)), order(b));
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

/// What the Markdown tables set side by side; a layer's only method stands in for `automatic` of a
/// peer.
struct Column {
  System system;
  Method method, else_method;
};
constexpr Column kColumns[] = {{System::gnomon, Method::automatic, Method::automatic},
                               {System::gnomon, Method::zpass, Method::zpass},
                               {System::gnomon, Method::zfail, Method::zfail},
                               {System::llvmpipe, Method::automatic, Method::automatic},
                               {System::llvmpipe, Method::zfail, Method::zfail},
                               {System::softpipe, Method::automatic, Method::zfail},
                               {System::embree, Method::rays, Method::rays}};

std::string markdown_of(const std::vector<Row>& rows, Stage stage) {
  std::string out = "| scene | size | threads |", rule = "| --- | --- | --- |";
  for (const auto& [system, method, other] : kColumns) {
    out += fmt::format(" {} {} |", name(system), name(method));
    rule += " --- |";
  }
  out += "\n" + rule + "\n";
  const Row* place = nullptr;
  for (const Line& line : lines_of(rows)) {
    if (place && same_place(*place, *line.first)) continue;
    place = line.first;
    std::string cells;
    bool any = false;
    for (const auto& [system, method, other] : kColumns) {
      const Row* row = find(rows, *place, system, method, stage);
      if (!row) row = find(rows, *place, system, other, stage);
      any = any || row;
      cells += " " + cell(row) + " |";
    }
    if (!any) continue;
    out +=
        fmt::format("| {} | {} | {} |{}\n", place->scene, text(place->size), place->threads, cells);
  }
  return out;
}

}  // namespace

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
  std::string out = fmt::format("{}; {}; commit {}; load at the start {:.2f}.\n\n", report.date,
                                report.processor, report.commit, report.load);
  out += "| goal | asked | measured |\n| --- | --- | --- |\n";
  for (const Goal& goal : goals(report.rows)) {
    out += fmt::format("| {} | {} | {}{} |\n", goal.what, goal.asked, goal.measured,
                       goal.met ? "" : " (missed)");
  }
  out += "\nThe whole frame, ms (of gnomon's):\n\n" + markdown_of(report.rows, Stage::frame);
  out += "\nThe volumes, ms (of gnomon's):\n\n" + markdown_of(report.rows, Stage::volumes);
  return out;
}

}  // namespace gnomon::bench
