#include "testing/text.h"

#include <algorithm>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <vector>

#include "raster/stencil_text.h"
#include "testing/difference.h"

namespace gnomon::testing {

namespace {

std::optional<std::uint8_t> value_of(char c) {
  for (int value = 0; value < 256; ++value)
    if (c != '#' && raster::stencil_glyph(static_cast<std::uint8_t>(value)) == c)
      return static_cast<std::uint8_t>(value);
  return std::nullopt;
}

[[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& why) {
  throw std::invalid_argument("stencil text, row " + std::to_string(row) + ", column " +
                              std::to_string(column) + ": " + why);
}

template <class Rows>
std::string range(const Rows& rows) {
  const auto [low, high] = std::minmax_element(rows.begin(), rows.end());
  return "values " + std::to_string(*low) + " to " + std::to_string(*high);
}

}  // namespace

std::string to_text(const raster::StencilBuffer& stencil) {
  return raster::stencil_text(stencil, {0, 0, stencil.width(), stencil.height()});
}

raster::StencilBuffer stencil_of(std::string_view text) {
  std::vector<std::vector<std::uint8_t>> rows(1);
  for (const char c : text) {
    if (c == ' ' || c == '\t' || c == '\r') continue;
    if (c == '\n') {
      if (!rows.back().empty()) rows.emplace_back();
      continue;
    }
    const std::optional<std::uint8_t> value = value_of(c);
    if (!value)
      refuse(rows.size(), rows.back().size() + 1,
             std::string("'") + c + "' stands for no one value (. 1-9 a-z A-Z do)");
    rows.back().push_back(*value);
  }
  if (rows.back().empty()) rows.pop_back();
  if (rows.empty()) throw std::invalid_argument("stencil text without a pixel");
  const std::size_t width = rows.front().size();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].size() != width)
      refuse(i + 1, rows[i].size(),
             "the row ends here, the first one at column " + std::to_string(width));
  const auto in_range = [](std::size_t size) {
    return static_cast<int>(std::min<std::size_t>(size, raster::kMaxTargetSize + 1));
  };
  raster::StencilBuffer stencil(in_range(width), in_range(rows.size()));
  for (int y = 0; y < stencil.height(); ++y)
    for (int x = 0; x < stencil.width(); ++x)
      stencil.plane().at(x, y) =
          rows[rows.size() - 1 - static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
  return stencil;
}

}  // namespace gnomon::testing

namespace gnomon::raster {

void PrintTo(const StencilBuffer& stencil, std::ostream* out) {
  *out << testing::kind(stencil) << ", " << testing::range(stencil.to_rows());
  if (stencil.width() > testing::kMaxPictureWidth || stencil.height() > testing::kMaxPictureHeight)
    return;
  *out << '\n' << testing::to_text(stencil);
}

void PrintTo(const DepthBuffer& depth, std::ostream* out) {
  *out << testing::kind(depth) << ", " << testing::range(depth.to_rows());
}

void PrintTo(const ColorBuffer& color, std::ostream* out) { *out << testing::kind(color); }

}  // namespace gnomon::raster
