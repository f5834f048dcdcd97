#include "bench/plot.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

namespace gnomon::bench {
namespace {

constexpr double kPanel = 520.0, kHeight = 400.0, kLeft = 62.0, kRight = 24.0, kTop = 34.0,
                 kBottom = 120.0;
constexpr std::size_t kLast = 4;

struct Line {
  std::string label, color;
  double width = 1.5;
  std::vector<std::pair<double, double>> points;
};

/// Decades that hold every value.
struct Axis {
  int low = 0, high = 1;
  double from = 0.0, to = 1.0;

  double at(double value) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
  }
};

Line make_line(const Curve& curve, Stage stage, std::string color, double width) {
  Line line{.color = std::move(color), .width = width, .points = {}};
  for (const Curve::Point& point : curve.points) {
    const auto ms = point.ms[static_cast<std::size_t>(stage)];
    if (ms && *ms > 0.0) line.points.emplace_back(point.x, *ms);
  }
  line.label = fmt::format("{} {}", name(curve.system), name(stage));
  if (const auto slope = curve.slope(stage, kLast)) {
    line.label += fmt::format(", slope {:.2f}", *slope);
  }
  return line;
}

std::vector<Line> lines_of(const std::vector<Curve>& curves) {
  std::vector<Line> lines;
  for (const Curve& curve : curves) {
    switch (curve.system) {
      case System::gnomon:
        lines.push_back(make_line(curve, Stage::frame, "#c0392b", 3.0));
        lines.push_back(make_line(curve, Stage::scene, "#e67e22", 1.5));
        lines.push_back(make_line(curve, Stage::volumes, "#8e44ad", 1.5));
        lines.push_back(make_line(curve, Stage::shadow, "#16a085", 1.5));
        break;
      case System::llvmpipe:
      case System::softpipe:
        lines.push_back(make_line(curve, Stage::frame, "#2c3e50", 2.0));
        break;
      case System::embree:
        lines.push_back(make_line(curve, Stage::frame, "#2980b9", 2.0));
        break;
    }
  }
  std::erase_if(lines, [](const Line& line) { return line.points.empty(); });
  return lines;
}

template <class Value>
Axis axis_over(const std::vector<Line>& lines, double from, double to, const Value& value) {
  double low = 1e300, high = 1e-300;
  for (const Line& line : lines) {
    for (const auto& point : line.points) {
      low = std::min(low, value(point));
      high = std::max(high, value(point));
    }
  }
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  return {first, std::max(last, first + 1), from, to};
}

std::string decade(int power) {
  static constexpr const char* kNames[] = {"0.001", "0.01", "0.1",  "1",  "10",  "100",
                                           "1k",    "10k",  "100k", "1M", "10M", "100M"};
  return power >= -3 && power <= 8 ? kNames[power + 3] : fmt::format("1e{}", power);
}

std::string label(double x, double y, const char* anchor, const std::string& text) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     text);
}

std::string grid(const Axis& x, const Axis& y) {
  std::string out;
  for (int power = x.low; power <= x.high; ++power) {
    const double at = x.at(std::pow(10.0, power));
    out +=
        fmt::format("<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#ddd\"/>\n", at, y.from, y.to);
    out += label(at, y.from + 18.0, "middle", decade(power));
  }
  for (int power = y.low; power <= y.high; ++power) {
    const double at = y.at(std::pow(10.0, power));
    out +=
        fmt::format("<path d=\"M{1:.1f} {0:.1f}H{2:.1f}\" stroke=\"#ddd\"/>\n", at, x.from, x.to);
    out += label(x.from - 6.0, at + 4.0, "end", decade(power));
  }
  return out;
}

std::string curve(const Line& line, const Axis& x, const Axis& y) {
  std::string path, dots;
  for (const auto& [px, py] : line.points) {
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.at(px), y.at(py));
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"{}\"/>\n", x.at(px),
                        y.at(py), line.color);
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n{}", path,
                     line.color, line.width, dots);
}

std::string panel(const std::vector<Curve>& curves, double left, const char* title,
                  const char* unit) {
  const std::vector<Line> lines = lines_of(curves);
  if (lines.empty()) return "";
  const Axis x = axis_over(lines, left + kLeft, left + kPanel - kRight,
                           [](const auto& point) { return point.first; });
  const Axis y =
      axis_over(lines, kHeight - kBottom, kTop, [](const auto& point) { return point.second; });
  std::string out = label((x.from + x.to) / 2.0, 20.0, "middle", title) + grid(x, y);
  out += label((x.from + x.to) / 2.0, y.from + 36.0, "middle", unit);
  out += label(x.from - 6.0, y.to - 8.0, "end", "ms");
  double row = y.from + 58.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += curve(lines[i], x, y);
    const double column = x.from + (i % 2 == 0 ? 0.0 : 225.0);
    out += fmt::format("<path d=\"M{:.1f} {:.1f}h20\" stroke=\"{}\" stroke-width=\"{}\"/>\n",
                       column, row - 4.0, lines[i].color, lines[i].width);
    out += label(column + 26.0, row, "start", lines[i].label);
    if (i % 2 == 1) row += 20.0;
  }
  return out;
}

}  // namespace

std::string plot_svg(const Growth& growth) {
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
             "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n"
             "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
             2.0 * kPanel, kHeight) +
         panel(growth.by_triangles, 0.0, "12 tori, ever finer, at 640x480", "triangles") +
         panel(growth.by_pixels, kPanel, "12 tori at ever larger sizes", "pixels") + "</svg>\n";
}

}  // namespace gnomon::bench
