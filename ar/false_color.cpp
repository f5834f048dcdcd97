#include "ar/false_color.h"

#include <algorithm>
#include <map>
#include <string>

#include <opencv2/imgproc.hpp>

namespace gnomon::ar {

namespace {

constexpr int kScaleEnd = 16;
constexpr int kLegendWidth = 190, kLegendRow = 18;

/// Corner colours of the scale for counts 1 to 16; lightness rises by equal steps (the "cividis"
/// hues, safe for all colour vision).
constexpr std::array<std::array<double, 3>, 5> kScale{
    {{0, 60, 130}, {60, 100, 150}, {120, 140, 150}, {190, 180, 110}, {255, 233, 70}}};

std::array<std::uint8_t, 3> mix(const std::array<double, 3>& a, const std::array<double, 3>& b,
                                double t) {
  std::array<std::uint8_t, 3> out{};
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(a[c] + (b[c] - a[c]) * t + 0.5);
  return out;
}

std::string legend_line(std::uint8_t value, int pixels) {
  std::string line = std::to_string(value);
  if (value >= 128) line += " (" + std::to_string(value - 256) + ")";
  return line + ": " + std::to_string(pixels) + " px";
}

}  // namespace

std::array<std::uint8_t, 3> stencil_color(std::uint8_t value) {
  if (value == 0) return {16, 16, 20};
  if (value >= 128) {
    const double depth_below = std::min(256 - value, kScaleEnd) / static_cast<double>(kScaleEnd);
    return mix({255, 150, 120}, {120, 0, 20}, depth_below);
  }
  // Small counts are the common ones: 1, 2, 3, 4 are a quarter of the scale apart, then the rest
  // follows.
  const double at = value <= 4 ? (value - 1) * 0.85 : 3.0 + std::min<double>(value - 4, 12) / 12.0;
  const auto i = static_cast<std::size_t>(std::min(at, 3.999));
  return mix(kScale[i], kScale[i + 1], at - static_cast<double>(i));
}

Image stencil_picture(int width, int height, const std::vector<std::uint8_t>& stencil) {
  std::map<std::uint8_t, int> pixels;
  for (const std::uint8_t value : stencil) ++pixels[value];
  const int rows = std::max(height, 40);
  Image out{width + kLegendWidth, rows, 3, {}};
  out.pixels.assign(static_cast<std::size_t>(out.width) * out.height * 3, 255);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      std::ranges::copy(stencil_color(stencil[static_cast<std::size_t>(y) * width + x]),
                        out.at(x, y));

  cv::Mat canvas(out.height, out.width, CV_8UC3, out.pixels.data());
  const auto text = [&](const std::string& line, int x, int y) {
    cv::putText(canvas, line, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.42, {0, 0, 0}, 1, cv::LINE_AA);
  };
  text("stencil count: pixels", width + 8, 16);
  int y = 26;
  for (const auto& [value, count] : pixels) {
    if (y + kLegendRow > rows) break;
    const auto color = stencil_color(value);
    cv::rectangle(canvas, {width + 8, y, 22, 14},
                  {double(color[0]), double(color[1]), double(color[2])}, cv::FILLED);
    text(legend_line(value, count), width + 38, y + 12);
    y += kLegendRow;
  }
  return out;
}

Image depth_picture(int width, int height, const std::vector<std::uint32_t>& depth,
                    std::uint32_t farthest) {
  std::uint32_t low = farthest, high = 0;
  for (const std::uint32_t d : depth)
    if (d != farthest) {
      low = std::min(low, d);
      high = std::max(high, d);
    }
  const double span = high > low ? static_cast<double>(high - low) : 1.0;
  Image out{width, height, 1, {}};
  out.pixels.reserve(depth.size());
  for (const std::uint32_t d : depth)
    out.pixels.push_back(d == farthest
                             ? std::uint8_t{0}
                             : static_cast<std::uint8_t>(255.5 - 215.0 * ((d - low) / span)));
  return out;
}

}  // namespace gnomon::ar
