#include "testing/difference.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>

namespace gnomon::testing {

namespace {

/// The sign of a pixel or block of which some parts are more and some less.
char merge(char a, char b) {
  if (a == ' ' || a == b) return b;
  if (b == ' ' || b == '.') return a;
  return a == '.' ? b : '*';
}

PixelDifference integer_difference(std::int64_t actual, std::int64_t expected, std::int64_t units) {
  const std::int64_t more = actual - expected;
  if (std::abs(more) <= units) return {};
  return {more > 0 ? '+' : '-', static_cast<double>(std::abs(more))};
}

PixelDifference float_difference(float actual, float expected) {
  if (std::bit_cast<std::uint32_t>(actual) == std::bit_cast<std::uint32_t>(expected)) return {};
  const double more = static_cast<double>(actual) - static_cast<double>(expected);
  if (std::isnan(more)) return {'*', std::numeric_limits<double>::infinity()};
  return {more > 0 ? '+' : more < 0 ? '-' : '*', std::abs(more)};
}

template <class Channels>
std::string tuple(const Channels& channels) {
  std::string text = "(";
  for (int c = 0; c < 4; ++c) {
    std::array<char, 32> number{};
    std::snprintf(number.data(), number.size(), "%.9g",
                  static_cast<double>(channels[static_cast<std::uint8_t>(c)]));
    text += (c ? ", " : "") + std::string(number.data());
  }
  return text + ")";
}

template <class Buffer>
std::string size(const Buffer& buffer) {
  return std::to_string(buffer.width()) + "x" + std::to_string(buffer.height());
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

/// Lines do not end in spaces: editors drop them from the texts that tests expect.
std::string line(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text + '\n';
}

}  // namespace

PixelDifference difference(const raster::StencilBuffer& actual,
                           const raster::StencilBuffer& expected, int x, int y,
                           std::uint32_t units) {
  return integer_difference(actual.at(x, y), expected.at(x, y), units);
}

PixelDifference difference(const raster::DepthBuffer& actual, const raster::DepthBuffer& expected,
                           int x, int y, std::uint32_t units) {
  return integer_difference(actual.at(x, y), expected.at(x, y), units);
}

PixelDifference difference(const raster::ColorBuffer& actual, const raster::ColorBuffer& expected,
                           int x, int y, std::uint32_t units) {
  PixelDifference all;
  for (int c = 0; c < 4; ++c) {
    const auto i = static_cast<std::uint8_t>(c);
    const PixelDifference channel =
        actual.format() == raster::ColorFormat::rgba8
            ? integer_difference(actual.rgba8().at(x, y)[i], expected.rgba8().at(x, y)[i], units)
            : float_difference(actual.rgba32f().at(x, y)[i], expected.rgba32f().at(x, y)[i]);
    all = {merge(all.sign, channel.sign), std::max(all.magnitude, channel.magnitude)};
  }
  return all;
}

std::string value(const raster::StencilBuffer& stencil, int x, int y) {
  return std::to_string(stencil.at(x, y));
}

std::string value(const raster::DepthBuffer& depth, int x, int y) {
  return std::to_string(depth.at(x, y));
}

std::string value(const raster::ColorBuffer& color, int x, int y) {
  return color.format() == raster::ColorFormat::rgba8 ? tuple(color.rgba8().at(x, y))
                                                      : tuple(color.rgba32f().at(x, y));
}

std::string kind(const raster::StencilBuffer& stencil) { return size(stencil) + " stencil buffer"; }

std::string kind(const raster::DepthBuffer& depth) {
  return size(depth) + (depth.format() == raster::DepthFormat::d24 ? " D24" : " D16") +
         " depth buffer";
}

std::string kind(const raster::ColorBuffer& color) {
  return size(color) + (color.format() == raster::ColorFormat::rgba8 ? " RGBA8" : " RGBA32F") +
         " colour buffer";
}

DifferenceMap::DifferenceMap(int width, int height)
    : width_(width),
      signs_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), ' '),
      x0_(width),
      y0_(height) {}

void DifferenceMap::add(int x, int y, const PixelDifference& pixel) {
  signs_[index(x, y)] = pixel.sign;
  ++compared_;
  if (pixel.sign == '.') return;
  if (differing_++ == 0) first_ = {x, y};
  if (pixel.magnitude > magnitude_) {
    magnitude_ = pixel.magnitude;
    largest_ = {x, y};
  }
  x0_ = std::min(x0_, x);
  x1_ = std::max(x1_, x);
  y0_ = std::min(y0_, y);
  y1_ = std::max(y1_, y);
}

char DifferenceMap::block_sign(int x, int y, int block) const {
  char sign = ' ';
  for (int v = y; v <= std::min(y + block - 1, y1_); ++v)
    for (int u = x; u <= std::min(x + block - 1, x1_); ++u) sign = merge(sign, signs_[index(u, v)]);
  return sign;
}

std::string DifferenceMap::picture(const std::vector<Column>& columns) const {
  const int width = x1_ - x0_ + 1, height = y1_ - y0_ + 1;
  const int block = std::max((width + kMaxPictureWidth - 1) / kMaxPictureWidth,
                             (height + kMaxPictureHeight - 1) / kMaxPictureHeight);
  const int columns_shown = static_cast<int>(columns.size()) + 1;
  const bool beside = block == 1 && columns_shown * width <= kMaxPictureWidth;
  // Two spaces between the columns, each as wide as its title or its pixels.
  const auto cell = [&](const std::string& text, const std::string& title) {
    return padded(text, std::max(title.size(), static_cast<std::size_t>(width)) + 2);
  };
  const auto label = [&](int y) {
    const int top = std::min(y + block - 1, y1_);
    return "y " + std::to_string(y) + (top > y ? "-" + std::to_string(top) : "");
  };
  std::size_t label_width = 0;
  for (int y = y0_; y <= y1_; y += block) label_width = std::max(label_width, label(y).size());
  label_width += 2;

  std::string rows, title;
  bool mixed = false, blank = false;
  for (int y = y0_; y <= y1_; y += block) {
    std::string row = padded(label(y), label_width), signs;
    if (beside)
      for (const Column& column : columns)
        row += cell(column.glyphs.substr(index(x0_, y), static_cast<std::size_t>(width)),
                    column.title);
    for (int x = x0_; x <= x1_; x += block) signs += block_sign(x, y, block);
    mixed = mixed || signs.find('*') != std::string::npos;
    blank = blank || signs.find(' ') != std::string::npos;
    rows.insert(0, line(row + signs));
  }
  if (beside && !columns.empty()) {
    title = std::string(label_width, ' ');
    for (const Column& column : columns) title += cell(column.title, column.title);
    title += "difference\n";
  }
  std::string legend = "x " + std::to_string(x0_);
  if (width > 1) legend += " to " + std::to_string(x1_);
  if (block > 1) {
    const std::string side = std::to_string(block);
    legend += ", a character for " + side + "x" + side + " pixels";
  }
  legend += "; . equal, + more, - less";
  if (mixed) legend += ", * mixed";
  if (blank) legend += ", blank not compared";
  return legend + '\n' + title + rows;
}

}  // namespace gnomon::testing
