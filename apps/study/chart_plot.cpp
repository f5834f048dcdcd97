#include "apps/study/chart_plot.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "apps/study/gnuplot.h"

namespace gnomon::apps::study {

namespace {

constexpr int kColumns = 3, kPanelWidth = 470, kPanelHeight = 380;
/// Okabe and Ito 2008: colours that colour-blind people tell apart.
constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#000000", "#e69f00", "#56b4e9", "#8c6d1f"};

using Points = std::vector<const ChartPoint*>;

struct Panel {
  std::string scene;
  Points points;
};

std::vector<Panel> panels_of(const ChartPart& part) {
  std::vector<Panel> panels;
  for (const ChartPoint& point : part.points) {
    if (point.times.frames == 0 || point.errors.empty()) continue;
    auto panel = std::ranges::find(panels, point.scene, &Panel::scene);
    if (panel == panels.end()) panel = panels.insert(panel, Panel{point.scene, {}});
    panel->points.push_back(&point);
  }
  return panels;
}

std::vector<std::string> families_of(const ChartPart& part) {
  std::vector<std::string> families;
  for (const ChartPoint& point : part.points)
    if (std::ranges::find(families, point.family) == families.end())
      families.push_back(point.family);
  return families;
}

/// Where an error of 0 is drawn on the logarithmic axis.
double floor_of(const Points& points) {
  double least = 0.0;
  for (const ChartPoint* point : points) {
    const double error = point->errors.front().second;
    if (error > 0.0 && (least == 0.0 || error < least)) least = error;
  }
  return least > 0.0 ? least / 3.0 : 1e-3;
}

std::string data_block(const std::string& name, const Points& points, double floor) {
  std::string out = fmt::format("${} << EOD\n", name);
  for (const ChartPoint* point : points)
    out += fmt::format("{} {} {} {}\n", point->times.median_ms,
                       std::max(point->errors.front().second, floor), point->times.low_ms,
                       point->times.high_ms);
  return out + "EOD\n";
}

std::string draw(const Panel& panel, const std::vector<std::string>& families) {
  const double floor = floor_of(panel.points);
  std::string out, plots;
  const auto add = [&](const std::string& what) {
    plots += (plots.empty() ? "" : ", \\\n") + what;
  };
  for (std::size_t i = 0; i < families.size(); ++i) {
    Points mine;
    std::ranges::copy_if(panel.points, std::back_inserter(mine),
                         [&](const ChartPoint* p) { return p->family == families[i]; });
    if (mine.empty()) continue;
    const std::string block = fmt::format("family{}", i);
    const char* const color = kColors[i % std::size(kColors)];
    out += data_block(block, mine, floor);
    add(fmt::format("${} using 1:2:3:4 with xerrorbars pt {} ps 0.7 lw 0.8 lc rgb '{}' title {}",
                    block, 5 + 2 * (i % 5), color, gnuplot_quoted(families[i])));
  }
  out += data_block("front", pareto_front(panel.points), floor);
  add("$front using 1:2 with steps lw 1 dt 2 lc rgb '#777777' title 'front'");
  out += fmt::format("set title {}\nset ylabel {}\n", gnuplot_quoted(panel.scene),
                     gnuplot_quoted(panel.points.front()->errors.front().first));
  return out + "plot " + plots + "\n";
}

}  // namespace

Points pareto_front(const Points& points) {
  Points sorted;
  std::ranges::copy_if(points, std::back_inserter(sorted),
                       [](const ChartPoint* p) { return p->times.frames > 0; });
  const auto key = [](const ChartPoint* p) {
    return std::pair(p->times.median_ms, p->errors.front().second);
  };
  std::ranges::sort(sorted, {}, key);
  Points front;
  for (const ChartPoint* point : sorted)
    if (front.empty() || point->errors.front().second < front.back()->errors.front().second)
      front.push_back(point);
  return front;
}

void plot_chart(const std::filesystem::path& file, const ChartPart& part) {
  const std::vector<Panel> panels = panels_of(part);
  if (panels.empty()) return;
  const int columns = std::min(kColumns, static_cast<int>(panels.size()));
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  std::string script = fmt::format(
      "set multiplot layout {},{}\n"
      "set logscale xy\nset grid lc rgb '#dddddd'\nset key font ',8' samplen 1\n"
      "set xlabel 'milliseconds a frame'\n",
      rows, columns);
  const std::vector<std::string> families = families_of(part);
  for (const Panel& panel : panels) script += draw(panel, families);
  plot(file, columns * kPanelWidth, rows * kPanelHeight, script + "unset multiplot\n");
}

}  // namespace gnomon::apps::study
