#include "apps/fit_report.h"

#include <cmath>

#include <fmt/format.h>

#include "ar/file.h"

namespace gnomon::apps {

using nlohmann::ordered_json;

namespace {

const char* unit_name(ar::ErrorUnit unit) { return unit == ar::ErrorUnit::flip ? "flip" : "px"; }

/// JSON has no infinity: null is more than is looked for.
ordered_json error_json(double error) {
  return std::isfinite(error) ? ordered_json(error) : ordered_json(nullptr);
}

ordered_json state_json(const ar::FitState& state) {
  return {{"error", error_json(state.error)},
          {"ms", state.ms},
          {"phantom_triangles", state.totals.phantom_triangles},
          {"casting_triangles", state.totals.casting_triangles},
          {"passes", state.passes}};
}

ordered_json finding_json(const ar::FitFinding& finding) {
  ordered_json given{{"option", finding.given}}, taken{{"option", finding.taken}};
  if (!finding.unit.empty()) {
    given["amount"] = finding.given_amount;
    taken["amount"] = finding.taken_amount;
  }
  ordered_json json{{"item", finding.item}, {"outcome", finding.outcome},
                    {"unit", finding.unit}, {"given", given},
                    {"taken", taken},       {"saves_ms", finding.saves_ms}};
  if (finding.next)
    json["next"] = {{"option", *finding.next}, {"error", error_json(finding.next_error)}};
  return json;
}

std::string state_row(const char* name, const FitReport& report, const ar::FitState& state) {
  return fmt::format("| {} | {} | {:.1f} | {} | {} | {} |\n", name,
                     ar::describe_error(report.bound.unit, state.error), state.ms,
                     state.totals.phantom_triangles, state.totals.casting_triangles, state.passes);
}

/// A table's cell on one line.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : ar::one_line(text)) out += c == '|' ? '/' : c;
  return out;
}

}  // namespace

ordered_json fit_json(const FitReport& report) {
  const ar::FitResult& result = *report.result;
  ordered_json items = ordered_json::array(), photographs = ordered_json::array();
  for (const ar::FitFinding& finding : result.findings) items.push_back(finding_json(finding));
  for (const auto& photograph : report.photographs) photographs.push_back(photograph.string());
  return {{"format", "gnomon-fit 1"},
          {"scene", report.scene.string()},
          {"photographs", photographs},
          {"bound", {{"value", report.bound.value}, {"unit", unit_name(report.bound.unit)}}},
          {"error", error_json(report.written_error)},
          {"before", state_json(result.before)},
          {"after", state_json(result.after)},
          {"items", items},
          {"left_out", result.left_out},
          {"frames_drawn", result.drawn}};
}

std::string fit_text(const FitReport& report) {
  const ar::FitResult& result = *report.result;
  std::string text = fmt::format(
      "# {}\n\nWithin {:g} {} of the exact scene, in {}.\n\n"
      "| | error | ms a frame | triangles of phantoms | triangles that cast | passes |\n"
      "| --- | --- | --- | --- | --- | --- |\n",
      cell(report.scene.string()), report.bound.value, unit_name(report.bound.unit),
      report.photographs.empty() ? "the scene's own view"
                                 : fmt::format("{} photographs", report.photographs.size()));
  text += state_row("as given", report, result.before);
  text += state_row("as found", report, result.after);
  text += fmt::format("\nRead again and drawn: {}. {} frames were drawn.\n\n",
                      ar::describe_error(report.bound.unit, report.written_error), result.drawn);
  text +=
      "| item | outcome | given | taken | its least saves | the next less would have |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  for (const ar::FitFinding& finding : result.findings)
    text += fmt::format(
        "| {} | {} | {} | {} | {:.1f} ms | {} |\n", cell(finding.item), finding.outcome,
        cell(finding.given), cell(finding.taken), finding.saves_ms,
        finding.next
            ? fmt::format("{} ({})", ar::describe_error(report.bound.unit, finding.next_error),
                          cell(*finding.next))
            : "");
  for (const std::string& name : result.left_out)
    text += fmt::format("\nObject '{}' is in no picture and stays as it is.\n", cell(name));
  return text;
}

}  // namespace gnomon::apps
