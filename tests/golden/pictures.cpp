#include "golden/pictures.h"

#include "ar/false_color.h"

namespace gnomon::golden {
namespace {

template <class T>
std::vector<T> rows_from_top(const std::vector<T>& from_bottom, int width, int height) {
  std::vector<T> rows;
  for (int y = height - 1; y >= 0; --y)
    rows.insert(rows.end(), from_bottom.begin() + static_cast<std::ptrdiff_t>(y) * width,
                from_bottom.begin() + static_cast<std::ptrdiff_t>(y + 1) * width);
  return rows;
}

}  // namespace

ar::Image color_picture(const Targets& targets) {
  const int width = targets.color.width(), height = targets.color.height();
  const std::vector<std::uint8_t> rgba =
      rows_from_top(targets.color.to_rgba8_rows(), 4 * width, height);
  ar::Image picture{width, height, 3, {}};
  for (std::size_t i = 0; i < rgba.size(); ++i)
    if (i % 4 != 3) picture.pixels.push_back(rgba[i]);
  return picture;
}

ar::Image depth_picture(const Targets& targets) {
  const int width = targets.depth.width(), height = targets.depth.height();
  return ar::depth_picture(width, height, rows_from_top(targets.depth.to_rows(), width, height),
                           targets.depth.max_value());
}

ar::Image stencil_picture(const Targets& targets) {
  const int width = targets.stencil.width(), height = targets.stencil.height();
  return ar::stencil_picture(width, height,
                             rows_from_top(targets.stencil.to_rows(), width, height));
}

}  // namespace gnomon::golden
