#include "golden/differences.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "ar/image_file.h"
#include "golden/pictures.h"

namespace gnomon::golden {
namespace {

/// One pixel's differences; absolute, 0 where the bits are the same.
struct PixelDifference {
  bool color = false;
  double color_amount = 0.0, depth = 0.0, stencil = 0.0;
};

PixelDifference difference_at(const Targets& a, const Targets& b, int x, int y) {
  PixelDifference result;
  if (a.color.format() == raster::ColorFormat::rgba8) {
    const raster::Rgba8 p = a.color.rgba8().at(x, y), q = b.color.rgba8().at(x, y);
    result.color = p != q;
    for (std::size_t i = 0; i < 4; ++i)
      result.color_amount = std::max(result.color_amount, std::abs(double{1} * p[i] - q[i]));
  } else {
    const glm::vec4 p = a.color.rgba32f().at(x, y), q = b.color.rgba32f().at(x, y);
    // Bits, so that -0 and 0 differ and a NaN is itself.
    result.color = std::memcmp(&p, &q, sizeof p) != 0;
    for (int i = 0; i < 4; ++i)
      result.color_amount = std::max(result.color_amount, std::abs(double{p[i]} - double{q[i]}));
  }
  result.depth = std::abs(double{1} * a.depth.at(x, y) - b.depth.at(x, y));
  result.stencil = std::abs(double{1} * a.stencil.at(x, y) - b.stencil.at(x, y));
  return result;
}

}  // namespace

Differences differences(const Targets& got, const Targets& expected) {
  Differences sum;
  for (int y = 0; y < got.color.height(); ++y)
    for (int x = 0; x < got.color.width(); ++x) {
      const PixelDifference d = difference_at(got, expected, x, y);
      sum.color_pixels += d.color;
      sum.depth_pixels += d.depth != 0.0;
      sum.stencil_pixels += d.stencil != 0.0;
      sum.color = std::max(sum.color, d.color_amount);
      sum.depth = std::max(sum.depth, d.depth);
      sum.stencil = std::max(sum.stencil, d.stencil);
    }
  return sum;
}

void write_differences(const std::filesystem::path& folder, const Targets& got,
                       const Targets& expected) {
  const int width = got.color.width(), height = got.color.height();
  ar::Image color{width, height, 1, {}}, depth = color, stencil = color;
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x) {
      const PixelDifference d = difference_at(got, expected, x, y);
      color.pixels.push_back(d.color ? 255 : 0);
      depth.pixels.push_back(d.depth != 0.0 ? 255 : 0);
      stencil.pixels.push_back(d.stencil != 0.0 ? 255 : 0);
    }
  std::filesystem::create_directories(folder);
  ar::write_png(folder / "color_difference.png", color);
  ar::write_png(folder / "depth_difference.png", depth);
  ar::write_png(folder / "stencil_difference.png", stencil);
  ar::write_png(folder / "color_got.png", color_picture(got));
  ar::write_png(folder / "depth_got.png", depth_picture(got));
  ar::write_png(folder / "stencil_got.png", stencil_picture(got));
}

std::string sentence(const Differences& d) {
  return fmt::format(
      "colour: {} pixels differ, by at most {}\ndepth: {} pixels differ, by at most {}\n"
      "stencil: {} pixels differ, by at most {}",
      d.color_pixels, d.color, d.depth_pixels, d.depth, d.stencil_pixels, d.stencil);
}

}  // namespace gnomon::golden
